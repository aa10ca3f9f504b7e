"""mua-bench: work counted by hand, the avatar it makes, and its output."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from commands import Commands, process
from synthetic_avatar import synthetic_avatar

import mua.bench.measure
import mua.gpu
from mua.asset import write
from mua.bench import work
from mua.bench.random_avatar import random_avatar
from mua.bench.work import Work
from mua.gpu import Bound
from mua.student.settings import preset

PAPER_TEXELS = 300_000  # paper, Animatable Coarse Geometry


def bound(kernel: str, sizes: dict[str, int] | None = None, **constants: int) -> Bound:
    """A dispatch without a device."""
    return Bound(kernel, sizes or {}, constants)


def cost(dispatch: Bound, share: float = 1.0) -> Work:
    return work.work_of(dispatch, share=share)


@pytest.mark.parametrize("kernel", ["MlpMatmul", "MlpMatmulTransposed"])
def test_layer_moves_its_weights_once(kernel: str) -> None:
    layer = bound(kernel, {"weight": 70, "bias": 20}, inputs=7, outputs=5)
    assert cost(layer) == Work(bytes=70 + 20 + 4 * 7 + 4 * 5, flops=70)


def test_blends_read_bases_and_coefficients_and_write_bands() -> None:
    shape = {"channels": 11, "rank": 5, "size": 3}
    plane = 4 * 3 * 2  # written as half floats: two words hold a row of three
    low = bound("BlendLl", {"mean": 4 * 99, "basis": 2 * 495}, **shape)
    assert cost(low) == Work(bytes=4 * 99 + 2 * 495 + 4 * 55 + 11 * plane, flops=2 * 495)
    band = bound("BlendDetail", {"mean": 2 * 297, "h": 2 * 495, "w": 2 * 495}, **shape)
    moved = 2 * 297 + 2 * 2 * 495 + 4 * 55 + 3 * 11 * plane
    assert cost(band) == Work(bytes=moved, flops=2 * (495 + 495 * 3))


def test_synthesis_of_one_channel_from_two_by_two() -> None:
    # a sample meets half of the 4 taps in each of two inputs: 2 x 8 samples after one axis, 16 after both
    level = bound("InverseDwt", channels=1, size=2, taps=4)
    assert cost(level) == Work(bytes=2 * (16 + 16) + 4 * 8, flops=2 * (2 * 8 * 4 + 16 * 4))


def test_upsampling_costs_what_its_valid_texels_need() -> None:
    # a filter of 3 samples by 4 phases, from 4 x 4 samples of 5 channels to 7 valid texels
    read = {"static_offset": 2 * 35, "tiles": 136 * 3, "upsampling": 4 * 12}
    levels = bound("UpsampleTexels", read, channels=5, size=4, texel_count=7, reach=3, factor=4)
    moved = 2 * 35 + 136 * 3 + 2 * 5 * 16 + 4 * 12 + 2 * 8 * 7
    assert cost(levels) == Work(bytes=moved, flops=35 * (2 * 3 + 2 * 3 // 4 + 1))


def test_a_face_costs_what_its_entries_and_the_texels_in_reach_need() -> None:
    entries = {"vertices": 4 * 10, "starts": 4 * 11, "expressions": 4 * 13, "changes": 8 * 25, "weights": 4 * 3}
    vertices = bound("SumTargets", entries | {"moved": 16 * 99, "mesh": 12 * 99}, vertex_count=10)
    assert cost(vertices) == Work(bytes=40 + 44 + 52 + 200 + 12 + 40 * 10, flops=2 * 100 + 30)
    read = {"corners": 12 * 6, "mesh": 12 * 99, "moved": 16 * 99, "triangle_bends": 24 * 6}
    triangles = bound("BendTriangles", read, triangle_count=6)
    assert cost(triangles) == Work(bytes=72 + 144, flops=6 * work.BEND_TRIANGLE)
    read = {"vertices": 4 * 8, "starts": 4 * 9, "stars": 12 * 6, "triangle_bends": 24 * 6, "moved": 16 * 99}
    vertices = bound("BendVertices", read | {"vertex_bends": 24 * 99}, vertex_count=8)
    assert cost(vertices) == Work(bytes=32 + 36 + 72 + 144 + (16 + 24) * 8, flops=18 * work.ADD_BEND + 8 * 12)
    reach = work.gathered(vertices=8, triangles=6, texels=5)
    assert reach == Work(bytes=(12 + 16 + 24) * 8 + 12 * 6 + (8 + 8 + 16) * 5, flops=5 * work.BEND_TEXEL)


def projected(texels: int, vertices: int, faces: int, eyes: int) -> Bound:
    read = {"mesh": 12 * vertices, "vertex_dq": 32 * vertices, "faces": 12 * faces, "texels": 8 * texels}
    return bound("SplatProject", read, texel_count=texels, eyes=eyes)


def test_posing_and_projection_read_and_write_each_record_once() -> None:
    read = {"joints": 32 * 3, "indices": 32 * 10, "weights": 32 * 10}
    assert cost(bound("BlendVertices", read, vertex_count=10)).bytes == 32 * 3 + (64 + 32) * 10
    seen = cost(projected(100, 10, 15, 2), share=0.6).bytes
    assert seen == (32 + 12) * 10 + 12 * 15 + (8 + 48 + 16 + 2) * 100 + 16 * 60


def test_a_second_eye_costs_operations_but_no_bytes() -> None:
    one, two = (cost(projected(300, 10, 15, eyes)) for eyes in (1, 2))
    assert two.flops - one.flops == 300 * work.PROJECT_EYE
    assert two.bytes == one.bytes


def sort(share: float) -> dict[str, int]:
    """Bytes of both passes of the sort of 5,000 keys."""
    kernels = ("CountDigits", "ScanDigits", "ScatterDigits")
    passes = [bound(kernel, key_count=5000, second_pass=p) for p in (0, 1) for kernel in kernels]
    return {kernel: spent.bytes for kernel, spent in work.by_kernel(passes, share=share).items()}


def test_sort_reads_keys_then_elements_and_writes_elements_then_the_order() -> None:
    first, last = 4 * 256 * 3, 4 * 256 * 2  # histograms of 5,000 keys in three groups, of the 4,000 seen in two
    assert sort(0.8) == {
        "CountDigits": 2 * 5000 + 4 * 4000 + first + last,
        "ScanDigits": 2 * (first + last + 4 * 256),
        "ScatterDigits": 2 * 5000 + 4 * 4000 + 8 * 4000 + first + last + 2 * 4 * 256,
    }


def test_second_pass_of_nothing_visible_moves_totals_alone() -> None:
    passes = [bound(kernel, key_count=5000, second_pass=1) for kernel in ("CountDigits", "ScanDigits", "ScatterDigits")]
    assert [cost(d, share=0).bytes for d in passes] == [0, 4 * 256, 4 * 256]


def test_random_avatar_has_the_shapes_of_its_preset() -> None:
    avatar = random_avatar(preset("paper"))
    assert avatar.geometry.ll_basis.shape == (11, 24, 48, 48)
    assert avatar.appearance.ranks == (64, 256, 64)
    assert avatar.geometry.details[1].h.shape == (3, 11, 16, 96)
    assert avatar.coarse.basis.shape == (72, 5508, 3)
    assert abs(len(avatar.rig.texels.texels) - PAPER_TEXELS) < 1000
    assert avatar.rig.texels.claimed_twice == 0
    assert (len(avatar.encoding.joints), avatar.encoding.rate, len(avatar.clips[0])) == (53, 25, 50)


def test_random_avatar_is_a_sound_file_and_the_same_twice(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write(tmp_path / name, random_avatar(preset("tiny")))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_prints_every_kernel_and_writes_the_same_figures(avatar_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "figures.json"
    asked = ("--frames", "2", "--size", "64x48", "--stereo", "--json", output)
    ran = process("bench", avatar_file, *asked, COLUMNS="160")
    assert ran.status == 0, ran.err
    figures = json.loads(output.read_text())
    assert (figures["screen_pixels"], figures["eyes"], figures["frames"]) == ([64, 48], 2, 2)
    assert 0 < figures["visible_splats"] <= figures["splats"]
    assert set(figures["kernels"]) == {*work.DECODING, *work.POSING}
    for name in (*figures["kernels"], figures["device"], "synthetic"):
        assert name in ran.out
    skin = figures["kernels"]["SplatProject"]
    assert skin["bytes_per_second"] == pytest.approx(1e3 * skin["bytes"] / skin["milliseconds"]["median"])
    assert skin["fraction_of_copy"] == pytest.approx(skin["bytes_per_second"] / figures["copy_bytes_per_second"])
    assert all(k["milliseconds"]["low"] <= k["milliseconds"]["high"] for k in figures["kernels"].values())


@pytest.mark.parametrize("more", [(), ("--model", "quest3"), ("--counts",)], ids=["measured", "modelled", "counted"])
def test_measures_as_many_frames_on_the_device_asked_for(
    command: Commands,
    avatar_file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    more: tuple[str, ...],
) -> None:
    asked: list[str | None] = []
    measured: list[int] = []
    open_device, measure = mua.gpu.open_device, mua.bench.measure.measure

    def opened(name: str | None) -> mua.gpu.Device:
        asked.append(name)
        return open_device(None)

    def keep(*given: Any, frames: int, **others: Any) -> mua.bench.measure.Measured:
        measured.append(frames)
        return measure(*given, frames=frames, **others)

    monkeypatch.setattr(mua.gpu, "open_device", opened)
    monkeypatch.setattr(mua.bench.measure, "measure", keep)
    frames = () if "--counts" in more else ("--frames", "3")
    ended = command("bench", avatar_file, "--device", "mine", *frames, *more, "--json", tmp_path / "figures.json")
    assert ended.status == 0, ended.err
    assert asked == ["mine"]
    assert measured == [3] * bool(frames)
    assert json.loads((tmp_path / "figures.json").read_text())


def test_measures_a_setting_without_a_file(command: Commands) -> None:
    ran = command("bench", "--preset", "tiny", "--frames", "1", "--size", "32")
    assert "random numbers, 192 texels" in ran.out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((), "expected one of the two"),
        (("a.muaavatar", "--preset", "tiny"), "expected one of the two"),
        (("--preset", "huge"), "expected one of tiny, preview, paper"),
        (("--preset", "tiny", "--size", "0"), "--size is '0'"),
        (("--preset", "tiny", "--device", "no such device"), "device no such device: "),
        (("--preset", "tiny", "--counts", "--size", "64"), "--size is given, but --counts counts one frame of one eye"),
        (("--preset", "tiny", "--counts", "--frames", "2"), "--frames is given, but --counts"),
        (("--preset", "tiny", "--model", "quest3", "--stereo"), "--stereo is given, but --model"),
        (("--preset", "tiny", "--model", "quest3", "--counts"), "--counts and --model are given"),
    ],
)
def test_refuses_in_one_sentence(command: Commands, arguments: tuple[str, ...], sentence: str) -> None:
    assert sentence in command("bench", *arguments).sentence


def test_refuses_an_avatar_without_clips(command: Commands, tmp_path: Path) -> None:
    write(tmp_path / "still.muaavatar", replace(synthetic_avatar(), clips=()))
    assert "holds no clips" in command("bench", tmp_path / "still.muaavatar", "--frames", "1").sentence
