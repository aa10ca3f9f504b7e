"""mua-bench: work counted by hand, the avatar it makes, and what it prints and writes."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import process
from synthetic_avatar import synthetic_avatar

from mua.asset import write
from mua.asset.count import flops, synthesis
from mua.asset.flatbuffer import Tree
from mua.asset.read import load
from mua.bench import counts, work
from mua.bench.random_avatar import random_avatar
from mua.bench.work import Work, frame_work
from mua.camera import orbit
from mua.decode import decode_clip_frame
from mua.gpu import Device
from mua.kernels.splat_project import half_lengths
from mua.player.buffers import AvatarBuffers
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.rendering import projected
from mua.student.settings import preset

PAPER_TEXELS = 300_000  # paper, Animatable Coarse Geometry
NETWORK = {
    "MlpMatmul": "coefficient MLPs",
    "MlpMatmulTransposed": "PCA mesh",
    "BlendLl": "LL blend",
    "BlendDetail": "detail blend",
}


def tensor(*shape: int, dtype: str = "<f2", scales: int = 0) -> Tree:
    """A stored tensor without content."""
    held = {"shape": np.array(shape), "data": np.zeros(np.prod(shape) * np.dtype(dtype).itemsize, np.uint8)}
    return {**held, "scale": np.zeros(scales, np.float32)} if scales else held


def test_layer_moves_its_weights_once() -> None:
    half = {"weight": tensor(5, 7), "bias": tensor(5, dtype="<f4")}
    assert work.mlp_matmul(half) == Work(bytes=2 * 35 + 4 * 5 + 4 * 7 + 4 * 5, flops=70)


def test_scales_of_i8_rows_are_moved_too() -> None:
    byte = {"weight": tensor(5, 7, dtype="i1", scales=5), "bias": tensor(5, dtype="<f4")}
    assert work.mlp_matmul(byte).bytes == 35 + 4 * 5 + 4 * 5 + 4 * 7 + 4 * 5


def test_pca_mesh_reads_its_basis_once() -> None:
    coarse = {"basis": tensor(4, 10, 3), "mean": tensor(10, 3, dtype="<f4")}
    assert work.mlp_matmul_transposed(coarse) == Work(bytes=2 * 120 + 4 * 30 + 4 * 4 + 4 * 30, flops=240)


def test_blends_read_bases_and_coefficients_and_write_bands() -> None:
    branch = {"ll_mean": tensor(11, 3, 3, dtype="<f4"), "ll_basis": tensor(11, 5, 3, 3)}
    assert work.blend_ll(branch) == Work(bytes=4 * 99 + 2 * 495 + 4 * 55 + 4 * 99, flops=2 * 495)
    band = {"mean": tensor(3, 11, 3, 3), "h": tensor(3, 11, 5, 3), "w": tensor(3, 11, 5, 3)}
    moved = 2 * 297 + 2 * 2 * 495 + 4 * 55 + 4 * 297
    assert work.blend_detail(band) == Work(bytes=moved, flops=2 * (495 + 495 * 3))


def test_synthesis_of_one_channel_from_two_by_two() -> None:
    # a sample meets half of the 4 taps in each of two inputs: 2 x 8 samples after one axis, 16 after both
    assert work.inverse_dwt(1, 2, 4) == Work(bytes=4 * (16 + 16 + 8), flops=2 * (2 * 8 * 4 + 16 * 4))


def test_upsampling_costs_what_its_valid_texels_need() -> None:
    # a filter of 3 samples by 4 phases; one level with details has doubled the 2 x 2 of LL
    branch = {"ll_mean": tensor(5, 2, 2), "static_offset": tensor(5, 7), "details": [{}]}
    moved = 2 * 35 + 132 * 3 + 4 * (5 * 16 + 12) + 2 * 8 * 7
    assert work.upsample_texels(branch, (3, 4), tiles=3) == Work(bytes=moved, flops=35 * (2 * 3 + 2 * 3 // 4 + 1))


def posed_tree(texels: int, vertices: int, faces: int) -> Tree:
    return {
        "texels": {"texels": tensor(texels)},
        "coarse": {"mean": tensor(vertices, 3)},
        "template": {"faces": tensor(faces, 3)},
    }


def test_posing_and_projection_read_and_write_each_record_once() -> None:
    assert work.blend_vertices(3, 10).bytes == 32 * 3 + (64 + 32) * 10
    seen = work.splat_project(posed_tree(100, 10, 15), 60, 2).bytes
    assert seen == (32 + 12) * 10 + 12 * 15 + (8 + 48 + 16 + 2) * 100 + 16 * 60


def test_a_second_eye_costs_operations_but_no_bytes() -> None:
    one, two = (work.splat_project(posed_tree(300, 10, 15), 200, eyes) for eyes in (1, 2))
    assert two.flops - one.flops == 300 * work.PROJECT_EYE
    assert two.bytes == one.bytes


def test_sort_reads_keys_then_elements_and_writes_elements_then_the_order() -> None:
    first, last = 4 * 256 * 3, 4 * 256 * 2  # histograms of 5,000 keys in three groups, of the 4,000 seen in two
    moved = work.splat_sort(5000, 4000)
    assert moved["CountDigits"].bytes == 2 * 5000 + 4 * 4000 + first + last
    assert moved["ScanDigits"].bytes == 2 * (first + last + 4 * 256)
    assert moved["ScatterDigits"].bytes == 2 * 5000 + 4 * 4000 + 8 * 4000 + first + last + 2 * 4 * 256


def test_nothing_visible_is_nothing_to_sort() -> None:
    assert {name: w.bytes for name, w in work.splat_sort(0, 0).items()} == {
        "CountDigits": 0,
        "ScanDigits": 2 * 4 * 256,
        "ScatterDigits": 2 * 4 * 256,
    }


def test_network_part_costs_what_the_asset_counts(avatar_file: Path) -> None:
    spent, counted = frame_work(load(avatar_file), visible=0, eyes=1), flops(synthetic_avatar())
    assert {name: spent[name].flops for name in NETWORK} == {n: counted[p] for n, p in NETWORK.items()}
    branches = (synthetic_avatar().geometry, synthetic_avatar().appearance)
    detailed = [(b.channels, b.ll_mean.shape[-1], len(b.details), len(b.details)) for b in branches]
    assert spent["InverseDwt"].flops == sum(synthesis(*levels, taps=10) for levels in detailed)


def test_random_avatar_has_the_papers_shapes() -> None:
    avatar = random_avatar(preset("paper"))
    assert avatar.geometry.ll_basis.shape == (11, 192, 48, 48)
    assert avatar.appearance.ranks == (128, 128, 96)
    assert avatar.geometry.details[1].h.shape == (3, 11, 96, 96)
    assert avatar.coarse.basis.shape == (128, 5508, 3)
    assert abs(len(avatar.rig.texels.texels) - PAPER_TEXELS) < 1000
    assert avatar.rig.texels.claimed_twice == 0


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
    assert list(figures["kernels"]) == list(frame_work(load(avatar_file), visible=1, eyes=1))
    for name in (*figures["kernels"], figures["device"], "synthetic"):
        assert name in ran.out
    skin = figures["kernels"]["SplatProject"]
    assert skin["bytes_per_second"] == pytest.approx(1e3 * skin["bytes"] / skin["milliseconds"]["median"])
    assert skin["fraction_of_copy"] == pytest.approx(skin["bytes_per_second"] / figures["copy_bytes_per_second"])
    assert all(k["milliseconds"]["low"] <= k["milliseconds"]["high"] for k in figures["kernels"].values())


def test_measures_a_setting_without_a_file() -> None:
    ran = process("bench", "--preset", "tiny", "--frames", "1", "--size", "32")
    assert "random numbers, 192 texels" in ran.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "expected one of the two"),
        (("a.muaavatar", "--preset", "tiny"), "expected one of the two"),
        (("--preset", "huge"), "expected one of tiny, preview, paper"),
        (("--preset", "tiny", "--size", "0"), "--size is '0'"),
        (("--preset", "tiny", "--device", "no such device"), "device no such device: "),
    ],
)
def test_refuses_in_one_sentence(arguments: tuple[str, ...], said: str) -> None:
    assert said in process("bench", *arguments).sentence


def test_refuses_an_avatar_without_clips(tmp_path: Path) -> None:
    write(tmp_path / "still.muaavatar", replace(synthetic_avatar(), clips=()))
    assert "holds no clips" in process("bench", tmp_path / "still.muaavatar", "--frames", "1").sentence


def test_counts_what_a_frame_must_do(avatar_file: Path, tmp_path: Path) -> None:
    output = tmp_path / "counts.json"
    ran = process("bench", avatar_file, "--counts", "--json", output)
    told = json.loads(output.read_text())
    assert all(name in ran.out for name in (*told["kernels"], "peak frame", "2.2"))
    assert told["dispatches"] == {"decode": 30, "pose": 8, "rest": 7}
    assert told["bytes"]["peak_frame"] == sum(kernel["bytes"] for kernel in told["kernels"].values())
    assert told["bytes"]["pose"] + told["bytes"]["decode"] == told["bytes"]["peak_frame"]
    assert told["triangles"]["2.2"] == 2 * told["splats"]
    assert 0 < told["fragments"]["2.2"] < told["fragments"]["1.0"] < told["fragments"]["0.6"]
    assert all(overdraw >= 1 for overdraw in told["overdraw"].values())


def test_fragments_are_the_pixels_of_all_quads(device: Device, avatar_file: Path) -> None:
    frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, avatar_file))])
    avatar, clip = frame.avatars[0].avatar.avatar, frame.avatars[0].avatar.avatar.clips[0]
    window = avatar.encoding.frames(0)
    commands = device.commands()
    frame.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
    camera = orbit(avatar.bounds, screen=(160, 200))
    frame.sort(commands, [camera])
    commands.submit()
    found = counts.fragments(device, frame.sorted, camera).sum()
    posed = decode_clip_frame(avatar, clip, frame=0, dtype=np.float64)
    seen = projected(posed, camera)
    lengths = half_lengths(seen.ellipses, seen.opacities)
    assert found == pytest.approx(4 * lengths.prod(axis=1).sum(), rel=0.02)  # all of them inside the picture
