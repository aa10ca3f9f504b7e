"""A bake with very small settings, and every way in which bad input ends it."""

import dataclasses
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from column_files import column_file
from commands import Commands, python
from gltf_files import animate, body
from PIL import Image
from recordings import content
from silent import Silent
from small_bakes import SMALL

from mua.asset import read
from mua.baking import pipeline
from mua.baking.distillation import Baked
from mua.baking.pipeline import bake, parts
from mua.baking.plan import plan, split
from mua.baking.resumed_recording import recording_key
from mua.baking.settings import BakeSettings
from mua.baking.sources import load_character
from mua.channels import ATTRIBUTES
from mua.errors import InputError
from mua.files.lock import DirectoryLock
from mua.pose.clip import is_range
from mua.pose.encoding import RATE
from mua.pose.resample import resample
from mua.recording import Recording
from mua.recording.workers import Worker
from mua.rig.bounds import playback_bounds
from mua.rig.expressions import Expressions


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> Baked:
    directory = tmp_path_factory.mktemp("bake")
    settings = BakeSettings(directory / "a.muaavatar", directory / "work", SMALL, "cpu")
    return bake(settings, Silent())


def test_leaves_an_avatar_that_reads_back(baked: Baked) -> None:
    avatar = read(baked.output)
    assert avatar.rig.texels.size == 64
    assert avatar.thumbnail


def test_the_file_holds_the_clips_of_the_character_whole_and_by_name(baked: Baked) -> None:
    """Not what was recorded of them: without --hold-out the ends are recorded apart."""
    stored, given = read(baked.output).clips, load_character(None, uv="auto", seed=0).clips
    assert [(clip.name, len(clip)) for clip in stored] == [(c.name, len(resample(c, RATE))) for c in given]
    assert baked.stored.clips == len(given)
    assert 0 < baked.stored.clip_bytes < baked.stored.file_bytes == baked.output.stat().st_size


def test_the_file_holds_triangles_over_its_texels(baked: Baked) -> None:
    avatar = read(baked.output)
    assert avatar.surface
    texels = avatar.rig.texels
    assert len(np.unique(avatar.surface.triangles(texels))) > 0.9 * len(texels.texels)


class Enough(Exception):
    """Ends a bake early."""


def stop(*_: object) -> None:
    raise Enough


def recording_of(directory: Path) -> Recording:
    (found,) = (path for path in (directory / "work").glob("recording-*") if path.is_dir())
    return Recording(found)


def test_the_range_of_motion_is_trained_on_and_nothing_else(baked: Baked) -> None:
    """Neither measured, pictured nor played; but the bounds hold it."""
    recording, avatar = recording_of(baked.output.parent), read(baked.output)
    ranged = [clip for clip in recording.clips if is_range(clip.name)]
    assert sum(len(clip.recorded) for clip in ranged) == recording.count() - SMALL.frames == SMALL.frames // 2
    assert not any(clip.held_out for clip in ranged)
    assert not any(is_range(frame.clip.name) for frame in recording.whole_frames())
    assert not any(is_range(clip.name) for clip in avatar.clips)
    measured = {clip.name for clip in recording.clips if clip.held_out and len(clip.recorded)}
    assert set(baked.errors) == {"training", *measured}
    assert baked.errors["training"].frames == SMALL.frames
    box, own = playback_bounds(recording.rig, ranged), playback_bounds(recording.rig, avatar.clips)
    assert (avatar.bounds[0] <= box[0]).all()
    assert (avatar.bounds[1] >= box[1]).all()
    assert (own[0] > box[0]).any()
    assert (own[1] < box[1]).any()


@pytest.mark.usefixtures("forked")
def test_without_the_range_the_same_is_recorded_of_the_users_motion(
    baked: Baked, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("mua.baking.pipeline.distil_student", stop)
    settings = BakeSettings(tmp_path / "a.muaavatar", tmp_path / "work", SMALL, "cpu", motion_range="none")
    with pytest.raises(Enough):
        bake(settings, Silent())
    one, other = recording_of(tmp_path), recording_of(baked.output.parent)
    character = load_character(None, uv="auto", seed=0)
    training, held = split([resample(clip, RATE) for clip in character.clips], ())
    planned = plan(training, held, frames=SMALL.frames)
    assert one.directory.name == f"recording-{recording_key(parts(settings, character), planned)}"
    assert one.count() == SMALL.frames
    for kind in (False, True):
        rows = range(one.count(kind))
        np.testing.assert_array_equal(one.meshes(rows, held_out=kind), other.meshes(rows, held_out=kind))
        for a, b in zip(*(which.subbands(slice(None), rows, held_out=kind) for which in (one, other)), strict=True):
            np.testing.assert_array_equal(a, b)
    for a, b in zip(one.clips, other.clips, strict=False):
        assert a.name == b.name
        np.testing.assert_array_equal(a.recorded, b.recorded)
        np.testing.assert_array_equal(a.rotations, b.rotations)


def test_the_file_says_what_was_held_out(baked: Baked) -> None:
    walk = read(baked.output).clips[0]
    assert f"held out of training: walk from frame {len(walk) - len(walk) // 5}, turn" in read(baked.output).notes
    figures = json.loads(baked.output.with_name("a_errors.json").read_text())
    assert figures["held_out_from"]["walk"] == len(walk) - len(walk) // 5


def test_leaves_a_contact_sheet_and_figures(baked: Baked) -> None:
    assert baked.sheet is not None
    assert baked.figures is not None
    with Image.open(baked.sheet) as sheet:
        assert np.asarray(sheet).std() > 0
    figures = json.loads(baked.output.with_name("a_errors.json").read_text())
    assert set(figures["groups"]["training"]["rms"]) == set(ATTRIBUTES)
    assert "explained" in baked.figures.read_text()


def test_baselines_stand_in_the_only_possible_order(baked: Baked) -> None:
    """Best coefficients beat the mean, and full bands beat best coefficients, on frames trained on."""
    errors = baked.errors["training"]
    for attribute in ("offset", "rotation", "SH"):
        assert errors.rms(attribute, "bands") < errors.rms(attribute, "best") < errors.rms(attribute, "mean")


@pytest.mark.usefixtures("forked")
def test_one_worker_and_several_leave_the_same_bytes(baked: Baked, tmp_path: Path) -> None:
    bake(BakeSettings(tmp_path / "a.muaavatar", tmp_path / "work", SMALL, "cpu", jobs=2), Silent())
    (mine,), (theirs,) = (list(path.glob("recording-*")) for path in (tmp_path / "work", baked.output.parent / "work"))
    assert content(mine) == content(theirs)
    assert (tmp_path / "a.muaavatar").read_bytes() == baked.output.read_bytes()


MESH = ("vertices", "faces", "uv", "uv_faces")
SKELETON = ("names", "parents", "bind_rotations", "bind_translations", "root")
CHARACTER = ("base_color", "skin_indices", "skin_weights", "looseness")
FACE = Expressions(
    names=("smile", "blink"),
    starts=np.array([0, 1, 2], np.int32),
    vertices=np.array([3, 4], np.int32),
    offsets=np.ones((2, 3), np.float32),
    rules=np.array([0, 3], np.int32),
)
EXPRESSIONS = ("names", "starts", "vertices", "offsets", "rules")


def _other(owner: object, name: str) -> Any:
    """Another value of a field."""
    value = getattr(owner, name)
    if isinstance(value, np.ndarray):
        other = value.copy()
        other.flat[-1] = not other.flat[-1]
        return other
    return tuple(f"{each}_" for each in value) if isinstance(value, tuple) else value + 1


def test_a_recording_of_another_surface_is_not_taken_for_this_one(tmp_path: Path) -> None:
    settings = BakeSettings(tmp_path / "a.muaavatar", tmp_path, SMALL, "cpu")
    character = dataclasses.replace(load_character(None, uv="auto", seed=0), expressions=FACE)
    mesh, skeleton = character.mesh, character.skeleton
    others = [
        *(
            dataclasses.replace(character, expressions=dataclasses.replace(FACE, **{name: _other(FACE, name)}))
            for name in EXPRESSIONS
        ),
        *(
            dataclasses.replace(character, mesh=dataclasses.replace(mesh, **{name: _other(mesh, name)}))
            for name in MESH
        ),
        *(
            dataclasses.replace(character, skeleton=dataclasses.replace(skeleton, **{name: _other(skeleton, name)}))
            for name in SKELETON
        ),
        *(dataclasses.replace(character, **{name: _other(character, name)}) for name in CHARACTER),
        dataclasses.replace(character, looseness=None),
    ]
    other_settings = [
        dataclasses.replace(settings, student=dataclasses.replace(SMALL, **{name: getattr(SMALL, name) + 32}))
        for name in ("texels", "seed")
    ]
    keys = [recording_key(parts(settings, one), []) for one in (character, character, *others)]
    keys += [recording_key(parts(one, character), []) for one in other_settings]
    assert keys[0] == keys[1]
    assert len(set(keys)) == 1 + len(others) + len(other_settings)


@pytest.fixture
def refused(forked: None, command: Commands, tmp_path: Path) -> Callable[..., str]:
    """The sentence that mua-bake ends with; an earlier result must survive and nothing new be left."""

    def run(*arguments: object) -> str:
        output = tmp_path / "out.muaavatar"
        output.write_bytes(b"an earlier result")
        before = sorted(tmp_path.iterdir())
        ended = command("bake", *arguments, "-o", output)
        assert output.read_bytes() == b"an earlier result"
        assert sorted(tmp_path.iterdir()) == before
        return ended.sentence

    return run


HALF = b"glTF\x02\0\0\0\xff\0\0\0"


def test_truncated_character_is_named(tmp_path: Path, refused: Callable[..., str]) -> None:
    (tmp_path / "half.glb").write_bytes(HALF)
    assert "half.glb" in refused(tmp_path / "half.glb")


ALIEN = """HIERARCHY
ROOT qqq
{
OFFSET 0 0 0
CHANNELS 3 Zrotation Xrotation Yrotation
JOINT zzz
{
OFFSET 0 1 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 1 0
}
}
}
MOTION
Frames: 2
Frame Time: 0.03
0 0 0 0 0 0
0 0 0 1 0 0
"""


@pytest.mark.parametrize(
    ("motion", "said"),
    [(ALIEN.replace("Frames: 2", "Frames: 0").partition("0.03\n")[0] + "0.03\n", ""), (ALIEN, "no joint name")],
    ids=["empty", "alien"],
)
def test_motion_that_moves_nothing_is_named(
    tmp_path: Path, refused: Callable[..., str], motion: str, said: str
) -> None:
    (tmp_path / "walk.bvh").write_text(motion)
    sentence = refused("--motion", tmp_path / "walk.bvh")
    assert "walk.bvh" in sentence
    assert said in sentence


def test_unknown_clip_to_store_is_named_before_anything_is_recorded(refused: Callable[..., str]) -> None:
    assert "--clips jump: there is no such clip; expected walk, turn" in refused("--clips", "jump")


@pytest.mark.parametrize("named", ["joint", "clip"])
def test_refuses_a_control_character_in_a_name_before_anything_is_recorded(
    tmp_path: Path, refused: Callable[..., str], named: str
) -> None:
    glb, bell = body(), "be\x07ll"
    glb.json["nodes"][1]["name"] = bell if named == "joint" else "spine"
    turns = [[0, 0, 0, 1], [0, 0, 1, 0]]
    animate(glb, 1, "rotation", times=[0, 1], values=turns, name=bell if named == "clip" else "wave")
    sentence = refused(glb.save(tmp_path / "hero.glb"), "--preset", "tiny")
    ending = ".glb" if named == "joint" else ""
    assert f"hero{ending}: the {named} 'be\\x07ll' has the control character U+0007" in sentence


@pytest.mark.long
def test_killed_bake_ends_in_the_same_bytes(baked: Baked, tmp_path: Path) -> None:
    """kill -9 while it records, then while it trains; the third run ends as an undisturbed one."""
    code = (
        "import sys; from pathlib import Path; sys.path.insert(0, sys.argv[1]); from test_bake import *;"
        "d = Path(sys.argv[2]); bake(BakeSettings(d / 'a.muaavatar', d / 'work', SMALL, 'cpu'), Silent())"
    )
    run = [sys.executable, "-c", code, str(Path(__file__).parent), str(tmp_path)]
    for sign in ("recording-*/reference.npz", "student/*"):
        process = subprocess.Popen(run)
        while process.poll() is None and not list((tmp_path / "work").glob(sign)):
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
    subprocess.run(run, check=True)
    assert (tmp_path / "a.muaavatar").read_bytes() == baked.output.read_bytes()


COMMAND = """
import atexit, os
from mua.baking import options
from mua.cli.bake import run
from small_bakes import SMALL

options.preset = lambda name: SMALL
os.register_at_fork(after_in_parent=lambda: atexit.register(print, "forked"))
run()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs Linux, where a process with threads can fork")
def test_a_command_records_in_a_fork_and_ends_in_the_same_bytes(baked: Baked, tmp_path: Path) -> None:
    output = tmp_path / "a.muaavatar"
    ended = python(COMMAND, "--device", "cpu", "--jobs", "1", "-o", output, PYTHONPATH=os.pathsep.join(sys.path))
    assert output.read_bytes() == baked.output.read_bytes(), ended.err
    assert ended.out.count("forked\n") == (not torch.cuda.is_available())
    assert [line for line in ended.out.splitlines() if line in ("character", "recording")] == ["character", "recording"]


def test_a_command_is_refused_where_another_is_at_work(tmp_path: Path, refused: Callable[..., str]) -> None:
    with DirectoryLock(tmp_path / "out.work", name="the other"):
        assert f"--work {tmp_path / 'out.work'}: process {os.getpid()} is using it" in refused()


def test_processes_wait_for_a_recording_only_where_there_is_none_and_a_character(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A bake that goes on may need none, and one whose file cannot be read ends before it needs them."""
    waited: list[int] = []

    def waiting(count: int, _: object) -> AbstractContextManager[list[Worker]]:
        waited.append(count)
        return nullcontext([])

    def bake_up_to_its_clips(character: Path | None) -> int:
        settings = BakeSettings(tmp_path / "a.muaavatar", tmp_path / "work", SMALL, "cpu", jobs=2, character=character)
        with pytest.raises((Enough, InputError)):
            bake(settings, Silent())
        return sum(waited)

    monkeypatch.setattr(pipeline, "waiting_workers", waiting)
    monkeypatch.setattr(pipeline, "clips_of", stop)
    (tmp_path / "half.glb").write_bytes(HALF)
    assert bake_up_to_its_clips(tmp_path / "half.glb") == 0
    assert bake_up_to_its_clips(column_file(tmp_path)) == 2
    assert bake_up_to_its_clips(None) == 4
    (tmp_path / "work" / "recording-of-another-run").mkdir(parents=True)
    assert bake_up_to_its_clips(column_file(tmp_path)) == bake_up_to_its_clips(None) == 4
