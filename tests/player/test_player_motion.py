"""The motion that an avatar plays: its own clips or another file's, at its own rate."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bvh_files import BVH
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.errors import InputError
from mua.live.receiver import Address, Receiver
from mua.player.motion import live_of, named_clip, player_clips, require_expressions, with_weights

FILE = Path("a.muaavatar")


def test_clips_of_the_file_come_at_the_avatars_rate() -> None:
    avatar = synthetic_avatar()
    faster = replace(avatar, clips=(replace(avatar.clips[0], rate=48.0),))
    clips, notes = player_clips(faster, FILE, motion=None, mapping=None)
    assert [(clip.name, clip.rate, len(clip)) for clip in clips] == [("wave", 24.0, 4)]
    assert notes == ()


def test_another_file_stands_in_for_the_avatars_clips(tmp_path: Path) -> None:
    directory = tmp_path / "motion"
    directory.mkdir()
    for name in ("a", "b"):
        (directory / f"{name}.bvh").write_text(BVH)
    mapping = {"root": "hips", "middle": "spine"}
    clips, notes = player_clips(synthetic_avatar(), FILE, motion=directory, mapping=mapping)
    assert [clip.rate for clip in clips] == [24.0, 24.0]
    assert len({clip.name for clip in clips}) == 2
    assert any("keep their bind rotation" in note for note in notes)


def test_refuses_an_avatar_without_clips_and_a_name_that_is_none() -> None:
    avatar = synthetic_avatar()
    with pytest.raises(InputError, match=r"a\.muaavatar holds no clips"):
        player_clips(replace(avatar, clips=()), FILE, motion=None, mapping=None)
    assert named_clip(avatar.clips, None, source=FILE) is avatar.clips[0]
    assert named_clip(avatar.clips, "wave", source=FILE) is avatar.clips[0]
    with pytest.raises(InputError, match=r"--clip is 'jump'; a\.muaavatar holds wave"):
        named_clip(avatar.clips, "jump", source=FILE)


def test_a_mapping_is_that_of_what_another_program_sends_too() -> None:
    sentence = r"a\.muaavatar.*source joint 'Tail' does not exist"
    with Receiver(Address(0)) as receiver, pytest.raises(InputError, match=sentence):
        live_of(synthetic_avatar(), FILE, receiver, {"root": "Tail"})


@pytest.mark.parametrize(("weights", "expected"), [(np.array([0.25, 0.5]), [1, 0.5]), (None, [1, 0])])
def test_expressions_that_are_not_named_keep_the_weights_of_the_clip(weights: Array | None, expected: Array) -> None:
    found = with_weights(("jawOpen", "mouthSmileLeft"), weights, {"jawOpen": 1.0})
    np.testing.assert_array_equal(found, expected)


def test_names_some_expressions_of_an_avatar_that_lacks_one() -> None:
    names = [f"shape {number}" for number in range(20)]
    require_expressions(names, {"shape 19": 1}, file=Path("a.muaavatar"))
    with pytest.raises(InputError, match=r"^--expressions has 'smoke'; a\.muaavatar has shape 0, .* and 12 more$"):
        require_expressions(names, {"smoke": 1}, file=Path("a.muaavatar"))
