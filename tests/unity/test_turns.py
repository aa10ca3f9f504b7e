"""Several AvatarRenderers take turns: what each displayed frame decodes and shows, bit for bit against one alone."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from component import Story, counts
from csharp import ROOT, CSharp, by_name
from frame_bounds import DECODE_ORDER, FRAME_ORDER, PARTS_ORDER
from replay import replay

from mua.arrays import Array
from mua.avatar.decode_turns import LONGEST, PARTS
from mua.gpu import Device

FRAMES, AVATARS = 48, 3
PART = max(map(len, PARTS_ORDER))
SORT = len(FRAME_ORDER) - len(DECODE_ORDER) - 2  # dispatches for all together
FILES = (0, 1, 0)  # of the avatars
OLDEST = max(LONGEST, AVATARS * PARTS) + 2 * PARTS  # displayed frames

Kept = dict[str, Array]


@pytest.fixture(scope="module")
def told(csharp: CSharp, component_program: Path, folder: Path, device: Device) -> tuple[dict[str, list[str]], Kept]:
    """What the story says, and what it and decodes of one avatar alone keep."""
    files = [folder / f"{name}.muaavatar" for name in ("first", "second")]

    @cache
    def played(story: str, name: str) -> tuple[dict[str, list[str]], Kept]:
        printed = csharp.run(component_program, ROOT / "ComputeShaders", story, *files)
        return by_name(printed), replay(device, folder / f"first {name}").kept

    reported, kept = played("TakesTurns", "turns")
    _, alone = played("DecodesAlone", "alone")
    return reported, {**{f"turns {label}": words for label, words in kept.items()}, **alone}


def frames_of(kept: Kept, avatar: int, displayed: int) -> list[int]:
    """The frames of its clip whose decode, made at once, is what an avatar shows."""
    shown = [kept[f"turns {avatar} {displayed} {name}"] for name in ("mesh", "texel_channels")]
    found = []
    for label in (label for label in kept if label.startswith(f"{FILES[avatar]} ") and label.endswith("mesh")):
        exact = [kept[label], kept[label.replace("mesh", "texel_channels")]]
        if all(np.array_equal(*pair) for pair in zip(shown, exact, strict=True)):
            found.append(int(label.split()[1]))
    return found


def test_a_displayed_frame_decodes_one_part_of_one_avatar(told: tuple[dict[str, list[str]], Kept]) -> None:
    dispatches = [int(value) for value in told[0]["dispatches"]]
    assert max(dispatches) == SORT + 2 * AVATARS + PART
    assert set(dispatches[AVATARS * (PARTS + 1) :]) == {SORT + 2 * AVATARS + len(part) for part in PARTS_ORDER}


def test_what_is_shown_is_the_decode_of_one_alone_and_not_old(told: tuple[dict[str, list[str]], Kept]) -> None:
    reported, kept = told
    count = max(int(label.split()[1]) for label in kept if label.startswith("0 ")) + 1
    due = np.array([int(frame) for frame in reported["frame"]]).reshape(FRAMES, AVATARS)
    seen: list[set[int]] = [set() for _ in range(AVATARS)]
    for displayed in range(AVATARS * (PARTS + 1), FRAMES):
        for avatar in range(AVATARS):
            shown = frames_of(kept, avatar, displayed)
            assert shown, f"avatar {avatar} in displayed frame {displayed}"
            seen[avatar].update(shown)
            recent = {int(frame) % count for frame in due[max(displayed - OLDEST, 0) : displayed + 1, avatar]}
            assert displayed < OLDEST or set(shown) & recent  # until then it may have begun before what is watched
    assert min(map(len, seen)) > 2


def test_avatars_are_drawn_from_their_first_decode_on(told: tuple[dict[str, list[str]], Kept]) -> None:
    drawn = np.array([int(value) for value in told[0]["drawn"]]).reshape(FRAMES, AVATARS)
    assert (np.diff(drawn, axis=0) >= 0).all()
    assert drawn[0].sum() < AVATARS  # undecoded
    assert drawn[AVATARS * (PARTS + 1) :].all()


def test_one_that_is_destroyed_or_leaves_the_view_gives_its_turn_to_the_next(story: Story) -> None:
    reported = story("LeavesItsTurn", "first", "second")
    left, back = ([int(value) for value in reported[name]] for name in ("left", "back"))
    assert reported["states"] == ["Ready Ready Ready"]
    assert set(left) == {SORT + 2 * 2 + len(part) for part in PARTS_ORDER}
    assert set(back) == {SORT + 2 * 3 + len(part) for part in PARTS_ORDER}
    assert reported["log"] == []


def test_a_budget_in_milliseconds_measures_itself(story: Story) -> None:
    """Where frames take too long, a part is decoded and fewer splats are shown; where they do not, all."""
    reported = story("MeasuresFrames", "first", "second")
    finest, coarsest = (sum(counts(seed)[level] for seed in (1, 2)) for level in (0, 2))
    assert reported["free"] == [str(finest)] * 2  # without a limit, only the decodes adapt
    assert reported["limited"] == [str(coarsest), str(finest), str(coarsest)]
    slow, fast, _, again = (int(value) for value in reported["most"])
    assert slow == SORT + 4 + PART
    assert fast == again > SORT + 4 + len(DECODE_ORDER) // 2
    assert reported["allocated"] == ["0"]
