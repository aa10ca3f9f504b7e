"""Reading motion by suffix: files, directories, and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from shared_data import SharedData

from mua.errors import InputError
from mua.motion.read import read_motion

STILL = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 1 0\nCHANNELS 0\n}\nMOTION\nFrames: 1\nFrame Time: 1\n"


def test_reads_a_directory_by_name_and_skips_other_files(tmp_path: Path) -> None:
    for name in ("b.bvh", "A.BVH"):
        (tmp_path / name).write_text(STILL)
    (tmp_path / "notes.txt").write_text("not motion")
    np.savez(tmp_path / "c.npz", poses=np.zeros((2, 72)), trans=np.zeros((2, 3)), mocap_framerate=60)
    assert [motion.clip.name for motion in read_motion(tmp_path)] == ["A", "b", "c"]


def test_reads_the_clips_of_a_rig(shared_data: SharedData) -> None:
    clips = [motion.clip for motion in read_motion(shared_data.path("characters/Fox.glb"))]
    assert [clip.name for clip in clips] == ["Survey", "Walk", "Run"]


@pytest.mark.parametrize(("name", "says"), [("absent.bvh", "does not exist"), ("notes.txt", r"\.txt")])
def test_refuses_what_holds_no_motion(tmp_path: Path, name: str, says: str) -> None:
    (tmp_path / "notes.txt").write_text("not motion")
    with pytest.raises(InputError, match=says):
        read_motion(tmp_path / name)


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("a.pkl", "may run code"),
        ("a.NPY", "numpy.savez"),
        ("a.c3d", "markers"),
        ("a.trc", "mua-capture poses"),
        ("a.amc", "export it as BVH"),
        ("a.json", "mua-capture poses makes an .npz"),
        ("a.tak", "export it from OptiTrack Motive"),
        ("a.mov", "estimate the person's poses"),
        ("a.anim", "export it from Unity"),
    ],
)
def test_says_how_to_convert_motion_of_other_kinds(tmp_path: Path, name: str, says: str) -> None:
    (tmp_path / name).write_bytes(b"\x80\x04")
    for path in (tmp_path / name, tmp_path):
        with pytest.raises(InputError, match=says):
            read_motion(path)


def test_refuses_a_directory_without_motion(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="found none"):
        read_motion(tmp_path)


def test_refuses_a_rig_without_clips(shared_data: SharedData) -> None:
    with pytest.raises(InputError, match="animation"):
        read_motion(shared_data.path("characters/White_F_3_Casual.glb"))
