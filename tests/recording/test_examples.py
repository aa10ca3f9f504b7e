"""The programs of docs/examples run as they stand."""

import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from commands import Commands
from examples import EXAMPLES, load_example
from PIL import Image
from python_blocks import python_blocks
from trainings import FINISHED, SMALL

from mua.asset.read import read
from mua.pose.clip import Clip
from mua.recording import Recording, TeacherWriter
from mua.student.settings import PRESETS


def test_a_teacher_of_ones_own_is_recorded_trained_and_seen(
    tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its commands run in this process, which has loaded what they load; the student takes a few steps."""
    monkeypatch.setitem(PRESETS, "tiny", SMALL)
    example, said = load_example("own_teacher"), []

    def run(line: list[str], *, check: bool) -> None:
        assert (line[:3], check) == ([sys.executable, "-m", "mua.cli.train"], True)
        ended = command("train", *line[3:])
        assert ended.status in FINISHED, ended.err
        said.append(ended.out)

    monkeypatch.setattr(example, "subprocess", SimpleNamespace(run=run))
    monkeypatch.setattr(sys, "argv", ["own_teacher.py", str(tmp_path)])
    example.main()
    assert "no mistake in units or conventions was found" in said[0]
    assert (tmp_path / "figure_check.png").is_file()
    assert [clip.name for clip in read(tmp_path / "figure.muaavatar").clips] == ["wave", "bow", "both"]
    picture = np.asarray(Image.open(tmp_path / "figure.png").convert("RGB"))
    assert 0.05 < np.mean(picture.min(axis=2) < 200) < 0.6  # a figure on white
    errors = (tmp_path / "figure_errors.md").read_text()
    assert "held out" in errors


def test_the_example_goes_on_where_it_was_killed(tmp_path: Path) -> None:
    example = load_example("own_teacher")
    example.FRAMES = {"wave": 3, "both": 2}  # type: ignore[attr-defined]
    example.record(tmp_path)
    example.FRAMES["bow"] = 2
    again = Recording(example.record(tmp_path))
    assert [clip.recorded.tolist() for clip in again.clips] == [[0], [0], [0]]
    assert {clip.name: len(clip) for clip in again.clips} == {"wave": 3, "both": 2, "bow": 2}


def test_the_loop_of_the_guide_records_each_clip_as_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    example = load_example("own_teacher")
    rig, rest = example.build_rig(), example.build_rig().skeleton.bind_pose
    clips = [
        Clip(name, 25.0, np.tile(rest.rotations, (5, 1, 1)), np.tile(rest.translations, (5, 1, 1)))
        for name in ("walk", "bow")
    ]

    def teacher(clip: Clip, frame: int) -> tuple[torch.Tensor, torch.Tensor]:
        mesh, texture = example.teacher(rig, clip.pose(frame))
        texture[:, 10] = 4 if clip.name == "walk" else 5
        return torch.from_numpy(mesh), torch.from_numpy(texture)

    loop = next(block for block in python_blocks(EXAMPLES.parent / "recording.md") if "with TeacherWriter" in block)
    exec(loop, {"rig": rig, "clips": clips, "teacher": teacher, "test_clips": ["bow"]})
    recording = Recording("recordings/subject01")
    assert [(clip.name, clip.held_out, clip.recorded.tolist()) for clip in recording.clips] == [
        ("walk", False, [0, 4]),
        ("bow", True, [0, 4]),
    ]
    opacities = [
        frame.texture[0, 10] for held_out in (False, True) for frame in recording.whole_frames(held_out=held_out)
    ]
    assert opacities == pytest.approx([4, 5], abs=1e-2)


def test_a_rig_in_centimetres_with_xyzw_is_recorded_as_the_guide_says(tmp_path: Path) -> None:
    example = load_example("own_teacher")
    own = example.build_rig()
    pose = example.poses(own, "both")[7]
    mesh, expected = example.teacher(own, pose)
    expected[:, 3:7] = [0.1, 0.2, 0.3, 0.9]
    expected[:, :3] = 0.004
    texture = expected.copy()
    texture[:, 0:3] *= 100
    texture[:, 3:7] = np.roll(texture[:, 3:7], -1, axis=1)
    texture[:, 7:10] = (texture[:, 7:10] + np.log(100)) / np.log(10)
    skeleton = own.skeleton
    given = {
        **{"names": skeleton.names, "parents": skeleton.parents, "skin_indices": own.skin_indices},
        **{"skin_weights": own.skin_weights, "bind_xyzw": np.roll(skeleton.bind_rotations, -1, axis=1)},
        **{"bind_cm": 100 * skeleton.bind_translations, "vertices_cm": 100 * own.mesh.vertices},
        **{"faces": own.mesh.faces, "uv": own.mesh.uv, "uv_faces": own.mesh.uv_faces, "texture": texture},
        **{"pose_xyzw": np.roll(pose.rotations, -1, axis=1), "pose_cm": 100 * pose.translations},
        "canonical_cm": 100 * mesh,
    }
    blocks = python_blocks(EXAMPLES.parent / "recording.md")
    rig_of, _, frame_of = next(block for block in blocks if "bind_cm" in block).partition("pose = ")
    exec(rig_of, given)
    with TeacherWriter(tmp_path / "r", given["rig"], rate=25.0) as writer:
        writer.start_clip("walk")
        exec(f"pose = {frame_of}", given | {"writer": writer})
    (frame,) = Recording(tmp_path / "r").whole_frames()
    assert frame.texture == pytest.approx(expected, abs=2e-3)
    assert frame.mesh == pytest.approx(mesh, abs=1e-5)
    assert Recording(tmp_path / "r").clips[0].rotations[0] == pytest.approx(pose.rotations)
