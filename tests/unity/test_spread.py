"""AvatarRenderer spreads a decode over displayed frames: what each shows, bit for bit against decodes at once."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from csharp import ROOT, CSharp
from frame_bounds import DECODE_ORDER, FRAME_ORDER, HALVES
from replay import replay
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset import write
from mua.gpu import Device

FRAMES = 24  # displayed
POSED = len(FRAME_ORDER) - len(DECODE_ORDER)  # dispatches of a frame that decodes nothing
SPREAD, AT_ONCE = "spread", "at once"
SHADOW = 3  # pass


@dataclass(frozen=True)
class Shown:
    """What the displayed frames of one playing show."""

    sets: int  # sets of channels
    dispatches: list[int]
    kept: list[tuple[Array, Array]]  # mesh and channels
    outside: list[str]  # how far outside of training what is shown is
    splats: list[int]
    shadows: list[bool]  # whether it falls from the mesh that is shown


Play = Callable[[str], tuple[Shown, Shown]]


@pytest.fixture(scope="module")
def play(csharp: CSharp, component_program: Path, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Play:
    """Plays each story once with the spread on and once off, and replays both on Vulkan."""

    @cache
    def played(story: str) -> tuple[Shown, Shown]:
        file = tmp_path_factory.mktemp(story) / "first.muaavatar"
        avatar = synthetic_avatar(1)
        write(file, replace(with_expressions(avatar), clips=avatar.clips), storage="f16")
        printed = csharp.run(component_program, ROOT / "ComputeShaders", story, file)
        reported = [line.split("\t", 1) for line in printed.splitlines()]
        assert ["alive", "0"] in reported
        sets = [int(value) for name, value in reported if name == "sets"]
        spread, at_once = (
            _shown(device, file.parent, name, reported, count)
            for name, count in zip((SPREAD, AT_ONCE), sets, strict=True)
        )
        return spread, at_once

    return played


def _shown(device: Device, folder: Path, name: str, reported: list[list[str]], sets: int) -> Shown:
    dispatches = [int(value) for label, value in reported if label == name]
    outside = [value for label, value in reported if label == f"outside {name}"]
    splats = [int(value) for label, value in reported if label == f"splats {name}"]
    recording = folder / f"first {name}"
    kept = replay(device, recording).kept
    pairs = [(kept[f"{i} mesh"], kept[f"{i} texel_channels"]) for i in range(FRAMES)]
    return Shown(sets, dispatches, pairs, outside, splats, _shadows(recording.with_suffix(".json")))


def _shadows(recording: Path) -> list[bool]:
    """Of each displayed frame, whether its last cast shadow is bound to the mesh that it keeps."""
    cast, bound = -1, []
    for line in recording.read_text().splitlines():
        event = json.loads(line)
        if event["event"] == "draw" and event["pass"] == SHADOW:
            cast = event["block_buffers"]["mesh"]
        if event["event"] == "keep" and event["label"].endswith(" mesh"):
            bound.append(event["buffer"] == cast)
    return bound


def alike(found: tuple[Array, Array], exact: tuple[Array, Array]) -> bool:
    return all(np.array_equal(*pair) for pair in zip(found, exact, strict=True))


def changes(shown: Shown) -> int:
    return sum(not alike(*pair) for pair in zip(shown.kept, shown.kept[1:], strict=False))


@pytest.mark.parametrize("story", ["SpreadsClip", "SpreadsBackwards"])
def test_a_clip_shows_in_every_displayed_frame_what_is_due_and_no_frame_decodes_all(play: Play, story: str) -> None:
    spread, at_once = play(story)
    assert changes(at_once) >= FRAMES // 3 - 1
    assert [alike(*pair) for pair in zip(spread.kept, at_once.kept, strict=True)] == [True] * FRAMES
    assert spread.outside == at_once.outside
    assert len(set(at_once.outside)) >= FRAMES // 3 - 1
    assert max(at_once.dispatches) == len(FRAME_ORDER)
    assert max(spread.dispatches[3:]) == POSED + max(HALVES)  # the first decode is at once
    assert (spread.sets, at_once.sets) == (2, 1)


def test_a_displayed_frame_of_two_cameras_decodes_one_part(play: Play) -> None:
    spread, at_once = play("SpreadsForTwoCameras")
    assert [alike(*pair) for pair in zip(spread.kept, at_once.kept, strict=True)] == [True] * FRAMES
    assert max(spread.dispatches[3:]) == 2 * POSED - 1 + max(HALVES)  # posed once, sorted for each


def test_another_level_comes_with_the_next_decode_and_makes_no_frame_decode_all(play: Play) -> None:
    """What was begun at the old level is shown when it is due."""
    spread, at_once = play("SpreadsOverLevels")
    assert len(set(at_once.splats)) == 2
    late = [spread.splats.index(min(at_once.splats)) - at_once.splats.index(min(at_once.splats))]
    late += [found[::-1].index(min(at_once.splats)) for found in (at_once.splats, spread.splats)]
    assert 0 < late[0] <= 5  # displayed frames; a pose is due after three
    assert 0 < late[1] - late[2] <= 5
    assert max(spread.dispatches[3:]) == POSED + max(HALVES)
    thirds = (spread.dispatches[6:], spread.dispatches[7:], spread.dispatches[8:])
    once = 3 * POSED + len(DECODE_ORDER)  # each half in one of three displayed frames
    assert {sum(frames) for frames in zip(*thirds, strict=False)} == {once}


def test_another_level_does_not_discard_what_is_decoded_already(play: Play) -> None:
    spread, at_once = play("SpreadsOverLevelsOnSlowerDisplay")
    assert len(set(spread.splats)) == 2
    assert max(at_once.dispatches[3:]) == len(FRAME_ORDER)
    assert max(spread.dispatches[3:]) < len(FRAME_ORDER)


def test_a_shadow_falls_from_the_mesh_that_is_shown(play: Play) -> None:
    """But for the first frame that is due before it is whole, as there was no time to look ahead."""
    spread, _ = play("SpreadsClip")
    assert spread.shadows[2:] == [True] * (FRAMES - 2)


@pytest.mark.parametrize("story", ["SpreadsOnSlowDisplay", "SpreadsOverSeeks", "SpreadsRigOnSlowDisplay"])
def test_what_cannot_be_spread_is_on_time_too(play: Play, story: str) -> None:
    spread, at_once = play(story)
    assert [alike(*pair) for pair in zip(spread.kept, at_once.kept, strict=True)] == [True] * FRAMES
    assert max(spread.dispatches) <= len(FRAME_ORDER)


def test_a_paused_clip_decodes_nothing_ahead(play: Play) -> None:
    spread, at_once = play("SpreadsOverSeeks")
    assert spread.dispatches[13] == spread.dispatches[16] == POSED - 1
    assert spread.dispatches[14] == len(FRAME_ORDER)  # sought
    assert spread.dispatches[12:17] == at_once.dispatches[12:17]


def test_a_rig_is_shown_one_displayed_frame_late(play: Play) -> None:
    spread, at_once = play("SpreadsRig")
    assert changes(at_once) >= FRAMES // 3 - 1
    assert alike(spread.kept[0], at_once.kept[0])
    late = zip(spread.kept[1:], at_once.kept, strict=False)
    assert [alike(*pair) for pair in late] == [True] * (FRAMES - 1)
    assert spread.outside[1:] == at_once.outside[:-1]
    assert max(spread.dispatches[1:]) == POSED + max(HALVES)


def test_a_face_that_moves_in_every_displayed_frame_is_decoded_at_the_avatars_rate(play: Play) -> None:
    """Shown one displayed frame late, as no frame decodes all."""
    spread, at_once = play("SpreadsFace")
    assert FRAMES // 3 - 1 <= changes(at_once) <= FRAMES // 3 + 1
    late = zip(spread.kept[2:], at_once.kept[1:], strict=False)
    assert [alike(*pair) for pair in late] == [True] * (FRAMES - 2)
    assert max(spread.dispatches[1:]) == POSED - 1 + HALVES[0] + 3 < POSED + len(DECODE_ORDER)  # not posed anew


def test_a_rig_that_nobody_saw_for_a_while_shows_its_pose_of_now(play: Play) -> None:
    """Seen again in frame 10."""
    spread, at_once = play("SpreadsRigThatIsNotSeen")
    assert alike(spread.kept[10], at_once.kept[10])
    assert not alike(spread.kept[10], spread.kept[9])
    late = zip(spread.kept[11:], at_once.kept[10:], strict=False)
    assert [alike(*pair) for pair in late] == [True] * (FRAMES - 11)
