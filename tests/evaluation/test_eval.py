"""mua-eval: images are the player's, tables say what was measured, one system's failure is its own."""

import csv
import json
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from commands import Commands
from PIL import Image
from recordings import clip
from synthetic_avatar import synthetic_avatar, synthetic_rig
from torch import Tensor

import mua
from mua import extras
from mua.arrays import Array
from mua.asset.write import write
from mua.cli import eval as command
from mua.errors import InputError
from mua.evaluation import scores
from mua.evaluation.entries import Entry, Picture, avatar_entries, mean_entry, sentence
from mua.evaluation.images import Studio
from mua.evaluation.scores import choose_frames
from mua.gpu import Device
from mua.player.buffers import AvatarBuffers
from mua.player.offscreen import Offscreen
from mua.player.toggles import Toggles
from mua.pose.skeleton import Pose
from mua.recording import PlannedClip, Recording, TeacherWriter, WholeFrame, record
from mua.student import settings as presets
from mua.teacher import TeacherFrame
from mua.training.optimise import Report
from mua.training.schedule import Schedule
from mua_research import recorded_systems
from mua_research.system import Budget, Motion, Sizes, TrainingFrames

SIZE = 176
SAME = 2 / 255  # in images of 0..1; allows for the recording's half precision and the order of equal depths
PROJECT = Path(mua.__file__).parents[1]
GOOD, BAD = "ours", "linear"  # what stands in for them
LEAST_PSNR = 50.0  # dB, beside the CPU rasteriser, as tests/parity


class PlayedTeacher:
    """The synthetic avatar as a teacher, so that a file of it is a perfect student."""

    def __init__(self) -> None:
        self.avatar = synthetic_avatar()
        self.rig = self.avatar.rig

    def frames(self, source, wanted):  # type: ignore[no-untyped-def]
        from mua.avatar.decode import decode_clip_frame

        for index in range(len(source)):
            if index not in wanted:
                yield source.pose(index)
                continue
            made = decode_clip_frame(self.avatar, source, frame=index)
            yield TeacherFrame(source.pose(index), made.canonical, made.texture)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """Two clips, three whole frames of each."""
    directory = tmp_path_factory.mktemp("eval") / "played"
    teacher = PlayedTeacher()
    kept = frozenset({1, 3, 5})
    planned = [
        PlannedClip(clip(teacher.rig, name, 6), held_out=held, wanted=frozenset(range(6)), whole=kept)
        for name, held in (("walk", False), ("turn", True))
    ]
    with TeacherWriter(directory, teacher.rig, rate=24.0) as writer:
        record(teacher, planned, writer)
    return Recording(directory)


@pytest.fixture(scope="module")
def frames(recording: Recording) -> list[WholeFrame]:
    return choose_frames(recording, None)


@pytest.fixture(scope="module")
def studio(device: Device, recording: Recording, frames: list[WholeFrame]) -> Studio:
    return Studio(device, recording.rig, frames, views=2, size=SIZE)


def saved(directory: Path, name: str = "played", storage: str = "f32") -> Path:
    path = directory / f"{name}.muaavatar"
    write(path, synthetic_avatar(), storage=storage)  # type: ignore[arg-type]
    return path


def truth(frame: WholeFrame) -> Picture:
    return Picture(frame.texture)


def noisy(frame: WholeFrame, amount: float = 0.05) -> Picture:
    rng = np.random.default_rng(frame.index)
    return Picture(frame.texture + amount * rng.standard_normal(frame.texture.shape).astype(np.float32))


def broken(frame: WholeFrame) -> Picture:
    if frame.index == 1 and not frame.clip.held_out:
        return truth(frame)
    raise ValueError("no texture\nfor this frame")


def psnr(image: Array, exact: Array) -> float:
    return float(-10 * np.log10(np.mean((image - exact) ** 2)))


def test_a_given_texture_is_drawn_as_the_player_draws_it(
    device: Device, studio: Studio, frames: list[WholeFrame], tmp_path: Path
) -> None:
    buffers = AvatarBuffers(device, saved(tmp_path))
    for frame in frames[::2]:
        player = Offscreen(device, buffers, frame.clip, Toggles())
        for camera, picture in zip(studio.cameras(frame), studio.draw(frame, frame.texture), strict=True):
            image = player.picture(frame.index, [camera])
            assert np.abs(picture - np.clip(image[..., :3], 0, 1)).max() < SAME
            assert picture.max() > 0.2  # there is something to see
    first, second = studio.draw(frames[1], frames[1].texture)
    assert psnr(first, second) < 30  # the views differ


def test_a_mesh_of_ones_own_is_drawn(studio: Studio, frames: list[WholeFrame]) -> None:
    frame = frames[0]
    (as_recorded, _), (same, _) = studio.draw(frame, frame.texture), studio.draw(frame, frame.texture, mesh=frame.mesh)
    (moved, _) = studio.draw(frame, frame.texture, mesh=frame.mesh + np.array([0, 0.2, 0], np.float32))
    np.testing.assert_array_equal(same, as_recorded)
    assert psnr(moved, as_recorded) < 30


def test_cameras_follow_the_root_at_one_distance(studio: Studio, frames: list[WholeFrame]) -> None:
    for view in range(2):
        cameras = [studio.cameras(frame)[view] for frame in frames]
        roots = [_root(frame) for frame in frames]
        offsets = [camera.position - root for camera, root in zip(cameras, roots, strict=True)]
        np.testing.assert_allclose(offsets, np.broadcast_to(offsets[0], (len(offsets), 3)), atol=1e-6)
    assert len({camera.position.tobytes() for camera in studio.cameras(frames[0])}) == 2


def _root(frame: WholeFrame) -> Array:
    pose: Pose = frame.clip.pose(frame.index)
    skeleton = synthetic_rig().skeleton
    return np.asarray(skeleton.world(pose.rotations, pose.translations)[1][skeleton.root])


@pytest.mark.parametrize(
    ("views", "size", "sentence"), [(2, 175, "--size 175"), (0, SIZE, "--views 0"), (17, SIZE, "--views 17")]
)
def test_refuses_too_few_and_too_many_views_and_pixels(
    recording: Recording, tmp_path: Path, views: int, size: int, sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        command.evaluate(recording=recording.directory, views=views, size=size, output=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_frames_are_chosen_evenly_and_of_both_kinds(recording: Recording) -> None:
    assert [(f.clip.name, f.index) for f in choose_frames(recording, None)] == [
        ("walk", 1), ("walk", 3), ("walk", 5), ("turn", 1), ("turn", 3), ("turn", 5),
    ]  # fmt: skip
    assert [(f.clip.name, f.index) for f in choose_frames(recording, 1)] == [("walk", 3), ("turn", 3)]


def test_a_file_of_the_teacher_is_a_perfect_student(
    device: Device, studio: Studio, recording: Recording, frames: list[WholeFrame], tmp_path: Path
) -> None:
    rows = [mean_entry(recording), *avatar_entries(device, saved(tmp_path), recording.rig, size=SIZE, played=True)]
    mean, common, own = scores.score(studio, frames, rows)
    assert [r.entry.name for r in (mean, common, own)] == ["mean texture", "played", "played, own mesh"]
    for held_out in (False, True):
        assert common.of(held_out).psnr > LEAST_PSNR  # what is left is the recording's half precision
        assert own.of(held_out).psnr > LEAST_PSNR
        assert mean.of(held_out).psnr < common.of(held_out).psnr - 5
        assert mean.of(held_out).flip > common.of(held_out).flip
    assert (common.entry.cost.storage, common.entry.cost.bytes) == (
        "f32",
        (tmp_path / "played.muaavatar").stat().st_size,
    )
    assert common.entry.cost.fps is not None
    assert common.entry.cost.fps > 0
    assert all(0 < sample.covered < 1 for sample in common.samples)


def test_a_file_of_another_rig_is_refused(device: Device, recording: Recording, tmp_path: Path) -> None:
    rig = recording.rig
    texels = replace(rig.texels, texels=rig.texels.texels[::-1].copy())
    renamed = replace(rig.skeleton, names=("root", "middle", "head"))
    path = saved(tmp_path)
    for other, part in ((replace(rig, texels=texels), "texels"), (replace(rig, skeleton=renamed), "joints")):
        with pytest.raises(InputError, match=rf"played\.muaavatar: its {part} are not those of the recording"):
            avatar_entries(device, path, other, size=SIZE, played=False)


def test_what_one_entry_stumbles_over_leaves_the_others(studio: Studio, frames: list[WholeFrame]) -> None:
    rows = [Entry("broken", broken), Entry("never", None, failure="it was never trained"), Entry("exact", truth)]
    done: list[tuple[int, int]] = []
    failed, never, exact = scores.score(studio, frames, rows, progress=lambda *at: done.append(at))
    assert failed.failure == "ValueError: no texture for this frame"
    assert [(s.clip, s.frame, s.view) for s in failed.samples] == [("walk", 1, 0), ("walk", 1, 1)]
    assert (never.failure, never.samples) == ("it was never trained", [])
    assert len(exact.samples) == 2 * len(frames)
    assert exact.of(True).psnr == math.inf
    assert done[-1] == (len(frames), len(frames))


def test_an_input_error_speaks_for_itself() -> None:
    assert sentence(InputError("budget: is  0")) == "budget: is 0"


class Fake:
    """Stands in for a system: the mean texture, or an error."""

    def __init__(self, name: str, sizes: Sizes) -> None:
        self.name, self.parameters, self.flops = name, 2_000_000, 30_000_000
        self._texels, self.components = len(sizes.texels), sizes.settings.components

    def fit(self, frames: TrainingFrames, budget: Budget, generator: torch.Generator, report: Report) -> None:
        if self.name == BAD:
            raise RuntimeError("no [place] left")
        self._mean = frames.mean_texture

    def state(self) -> dict[str, Tensor]:
        return {"mean": self._mean}

    def restore(self, state: dict[str, Tensor], frames: TrainingFrames) -> None:
        self._mean = state["mean"]

    def textures(self, motion: Motion) -> Tensor:
        return self._mean.expand(len(motion), self._texels, 23)


@pytest.fixture
def faked(monkeypatch: pytest.MonkeyPatch) -> None:
    systems = {name: lambda sizes, name=name: Fake(name, sizes) for name in (GOOD, BAD)}
    monkeypatch.setattr(recorded_systems, "SYSTEMS", systems)
    quick = replace(presets.PRESETS["tiny"], regression=Schedule(steps=5, batch=8, lr=1e-3), components=3)
    monkeypatch.setitem(presets.PRESETS, "tiny", quick)


def test_the_command_writes_tables_plots_and_sheets(
    recording: Recording, tmp_path: Path, faked: None, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out"
    files = [saved(tmp_path, storage, storage) for storage in ("f32", "i8")]
    command.evaluate(
        recording=recording.directory, avatars=files, system=["all"], seconds=1, preset="tiny", frames=1, views=1,
        size=SIZE, output=output,
    )  # fmt: skip
    pictures = ("error_by_frame", "rate_distortion", "training", "held_out")
    names = [f"{name}.png" for name in pictures] + ["results.csv", "results.json", "results.md", "work"]
    assert sorted(path.name for path in output.iterdir()) == sorted(names)
    for name in pictures:
        with Image.open(output / f"{name}.png") as image:
            assert np.asarray(image).std() > 5

    results = json.loads((output / "results.json").read_text())
    systems = {row["system"]: row for row in results["systems"]}
    assert list(systems) == ["mean texture", "f32", "i8", GOOD, BAD]
    assert systems[BAD]["failure"] == "RuntimeError: no [place] left"
    assert systems[BAD]["mean"]["training"]["psnr"] is None
    assert systems[GOOD]["mean"]["held out"] == systems["mean texture"]["mean"]["held out"]
    assert (systems[GOOD]["parameters"], systems[GOOD]["bytes"], systems[GOOD]["fps"]) == (
        2_000_000,
        8_000_000,
        None,
    )
    assert results["setting"]["frames"] == {"training": 1, "held out": 1}
    assert results["setting"]["size"] == SIZE
    assert [(p["clip"], p["frame"]) for p in systems["i8"]["pictures"]] == [("walk", 3), ("turn", 3)]

    rows = list(csv.DictReader((output / "results.csv").read_text().splitlines()))
    assert float(rows[1]["held out psnr"]) == systems["f32"]["mean"]["held out"]["psnr"]
    assert (rows[1]["training lpips"], rows[4]["failure"]) == ("", "RuntimeError: no [place] left")
    markdown = (output / "results.md").read_text()
    assert "no weights given" in markdown
    assert f"- {BAD}: RuntimeError: no [place] left" in markdown
    assert "| f32 | f32 | " in markdown
    assert "+0.000" in markdown
    assert "no [place] left" in capsys.readouterr().out


class Weighed:
    """Stands in for LPIPS: a distance that the file of weights says."""

    network = "alex"

    def __init__(self, path: Path) -> None:
        self._score = float(path.read_text())

    def __call__(self, image: Tensor, truth: Tensor) -> float:
        return self._score


def test_every_option_of_the_images_counts(
    recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mua.cli.recording_evaluation.Lpips", Weighed)
    monkeypatch.setitem(sys.modules, "mua_research", None)  # only systems need it
    (tmp_path / "weights").write_text("0.25")
    command.evaluate(
        recording=recording.directory, avatars=[saved(tmp_path)], frames=1, views=3, size=SIZE, own_mesh=True,
        lpips_weights=tmp_path / "weights", output=tmp_path / "out",
    )  # fmt: skip
    results = json.loads((tmp_path / "out" / "results.json").read_text())
    assert [row["system"] for row in results["systems"]] == ["mean texture", "played", "played, own mesh"]
    for row in results["systems"]:
        assert [(one["clip"], one["view"]) for one in row["pictures"]] == [
            (name, view) for name in ("walk", "turn") for view in range(3)
        ]
        assert row["mean"]["training"]["lpips"] == row["mean"]["held out"]["lpips"] == 250
    with pytest.raises(InputError, match="no such device here"):
        command.evaluate(recording=recording.directory, device="no such device here", output=tmp_path / "other")


def test_a_trained_system_is_not_trained_again(
    recording: Recording, tmp_path: Path, faked: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    trained: list[str] = []
    budgets: list[tuple[float | None, int | None]] = []
    components: set[int] = set()
    fit = Fake.fit

    def counted(self: Fake, *given: Any) -> None:
        trained.append(self.name)
        budgets.append((given[1].seconds, given[1].steps))
        components.add(self.components)
        fit(self, *given)

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Fake, "fit", counted)
    monkeypatch.setattr(scores, "score", interrupted)
    for seed, steps, version in ((0, None, "a"), (0, None, "a"), (1, None, "a"), (1, 7, "a"), (1, 7, "b")):
        monkeypatch.setattr("mua.training.checkpoint.__version__", version)
        with pytest.raises(KeyboardInterrupt):
            command.evaluate(
                recording=recording.directory, system=[GOOD, BAD], seconds=1.0, steps=steps, preset="tiny",
                frames=1, views=1, size=SIZE, seed=seed, output=tmp_path,
            )  # fmt: skip
    assert trained == [GOOD, BAD, BAD, *[GOOD, BAD] * 3]
    assert budgets == [(1.0, None)] * 5 + [(None, 7)] * 4
    assert components == {3}, "those of the preset"


def test_an_unknown_system_is_named(recording: Recording, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--system nerf: expected one of all, pca-only, "):
        command.evaluate(recording=recording.directory, system=["nerf"], output=tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("beside", ["checkout", "wheel"])
def test_a_system_without_the_package_that_trains_it_names_what_to_install(
    beside: str, written: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    if beside == "wheel":
        monkeypatch.setattr(extras, "__file__", str(tmp_path / "mua" / "extras.py"))
    monkeypatch.setitem(sys.modules, "mua_research", None)
    sentence = command("eval", written, "--system", "ours", "-o", tmp_path / "out").sentence
    assert "--system ours: needs the Python package mua_research, which is not here: " in sentence
    named = {"checkout": f'install -e "{PROJECT}/research"', "wheel": "pip install -e python/research in a checkout"}
    assert named[beside] in sentence
    assert not (tmp_path / "out").exists()
