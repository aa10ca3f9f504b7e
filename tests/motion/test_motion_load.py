"""Motion from files arrives on the character's own skeleton, as it stands or retargeted."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bvh_files import BVH

from mua import rotation
from mua.errors import InputError
from mua.motion.load import counted, load_motions, same_joints, unique_names
from mua.motion.read import read_motion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton


@pytest.fixture
def motion(tmp_path: Path) -> Path:
    path = tmp_path / "wave.bvh"
    path.write_text(BVH)
    return path


def twice_as_large(skeleton: Skeleton) -> Skeleton:
    """The skeleton at twice its size, with names that say nothing."""
    names = tuple(f"j{i}" for i in range(len(skeleton.names)))
    return replace(skeleton, names=names, bind_translations=2 * skeleton.bind_translations)


def test_takes_motion_on_the_same_joints_as_it_stands(motion: Path) -> None:
    source = read_motion(motion)[0]
    assert same_joints(source.skeleton, source.skeleton)
    clips = [one.clip for one in load_motions(motion, source.skeleton, mapping=None, rate=20.0)]
    assert [(clip.rate, len(clip)) for clip in clips] == [(20.0, 5)]
    np.testing.assert_allclose(clips[0].rotations[::2], source.clip.rotations, atol=1e-12)


@pytest.mark.parametrize("away", [900.0, 10.0])
def test_a_pose_before_the_motion_is_left_out(motion: Path, away: float) -> None:
    (source,) = read_motion(motion)
    begin, rows = BVH.splitlines()[-3], 9 * BVH.splitlines()[-3:]
    apart = [f"{away} {begin.split(maxsplit=1)[1]}"]
    header = BVH[: BVH.index("Frames:")]
    motion.write_text(header + "\n".join(["Frames: 28", "Frame Time: 0.1", *apart, *rows]) + "\n")
    (loaded,) = load_motions(motion, source.skeleton, mapping=None, rate=10.0)
    assert len(loaded.clip) == (27 if away > 100 else 28)
    assert [note for note in loaded.notes if "the first frame" in note] == (
        ["wave: the first frame, a pose apart from the motion, is left out."] if away > 100 else []
    )


def test_puts_motion_on_joints_of_other_names_by_a_mapping(motion: Path) -> None:
    source = read_motion(motion)[0]
    other = twice_as_large(source.skeleton)
    loaded = load_motions(motion, other, mapping={"j0": "hips", "j1": "spine"}, rate=10.0)
    clips = [one.clip for one in loaded]
    assert len(clips[0]) == 3
    turned = rotation.multiply(rotation.conjugate(clips[0].rotations[0, 1]), clips[0].rotations[2, 1])
    assert np.degrees(2 * np.arccos(abs(turned[0]))) == pytest.approx(20, abs=1e-6)


def test_puts_motion_on_joints_whose_parts_the_characters_file_says(motion: Path) -> None:
    source = read_motion(motion)[0]
    other = twice_as_large(source.skeleton)
    said = {"j0": "hips", "j1": "spine"}
    (loaded,) = load_motions(motion, other, mapping=None, rate=10.0, roles=said, refuse=False)
    assert sorted(loaded.matches.chains) == [0, 1]
    (silent,) = load_motions(motion, other, mapping=None, rate=10.0, refuse=False)
    assert 1 not in silent.matches.chains


def test_clips_of_one_name_are_numbered_from_the_second_on() -> None:
    clips = [Clip(name, 30.0, np.zeros((1, 1, 4)), np.zeros((1, 1, 3))) for name in ("a", "b", "a", "a")]
    assert [clip.name for clip in unique_names(clips)] == ["a", "b", "a 2", "a 3"]


def test_refuses_motion_whose_joints_match_none_and_names_the_file(motion: Path) -> None:
    source = read_motion(motion)[0]
    with pytest.raises(InputError, match=r"wave\.bvh"):
        load_motions(motion, twice_as_large(source.skeleton), mapping=None, rate=10.0)


def test_what_several_clips_bring_is_said_once_with_their_number() -> None:
    clips = [Clip(name, 30.0, np.zeros((1, 1, 4)), np.zeros((1, 1, 3))) for name in ("a", "b", "c")]
    notes = ["a: slides.", "b.bvh: slides.", "no joint moves.", "no joint moves.", "c: falls.", "d: slides."]
    assert counted(notes, clips) == ("2 clips: slides.", "2 clips: no joint moves.", "c: falls.", "d: slides.")
