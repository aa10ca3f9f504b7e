"""A bake goes on from a recording only where it is byte for byte what its plan's writer left."""

import re
import shutil
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest
from recordings import RATE, FormulaTeacher, opened, plan
from synthetic_avatar import synthetic_rig

from mua.errors import InputError
from mua.recording import PlannedClip, record
from mua.recording.damage import check


def flip(path: Path, at: float = 0.5) -> None:
    content = bytearray(path.read_bytes())
    content[int(at * (len(content) - 1))] ^= 1
    path.write_bytes(content)


def other_number(field: str) -> Callable[[Path], None]:
    """Makes a JSON file say another number after `field`, so that it parses still."""

    def change(path: Path) -> None:
        text, count = re.subn(rf'("{field}": \[?\s*)\d', r"\g<1>9", path.read_text(), count=1)
        assert count
        path.write_text(text)

    return change


LAST = "shards/00006"
DAMAGES = [
    ("recording.json", other_number("rate")),
    ("recording.json", other_number("valid_texels")),
    ("recording.json", Path.unlink),
    ("rig.npz", flip),
    ("reference.npz", flip),
    ("reference.npz", Path.unlink),
    ("shards/00000", shutil.rmtree),
    (LAST, shutil.rmtree),
    ("shards/00000/index.json", Path.unlink),
    *[("shards/00001/index.json", other_number(f)) for f in ("recorded", "whole", "start", "poses", "training_frames")],
    ("shards/00000/index.json", other_number("d2.npy")),  # its checksum
    *[(f"shards/00001/{name}.npy", flip) for name in ("rotations", "translations", "meshes", "ll", "d3", "d2")],
    ("shards/00001/whole_00001.npy", flip),
    ("shards/00001/whole_00001.npy", Path.unlink),
    (f"{LAST}/sum.npy", lambda path: flip(path, 1.0)),
]


@pytest.mark.parametrize(("name", "damage"), DAMAGES, ids=[f"{n}-{k}" for k, (n, _) in enumerate(DAMAGES)])
def test_damage_of_any_file_is_found(written: Path, tmp_path: Path, name: str, damage: Callable[[Path], None]) -> None:
    planned = plan(synthetic_rig())
    check(written, planned, rate=RATE, whole=True)
    copy = Path(shutil.copytree(written, tmp_path / "copy"))
    damage(copy / name)
    with pytest.raises(InputError, match=re.escape(str(copy))):
        check(copy, planned, rate=RATE, whole=True)


def test_a_recording_that_a_kill_cut_short_is_no_damage_but_not_whole(tmp_path: Path) -> None:
    teacher = FormulaTeacher(synthetic_rig())

    def die(done: int) -> None:
        if done == 6:
            raise KeyboardInterrupt

    with (
        suppress(KeyboardInterrupt),
        opened(tmp_path, shard_frames=4) as writer,
    ):
        record(teacher, plan(teacher.rig), writer, progress=die)
    check(tmp_path, plan(teacher.rig), rate=RATE, whole=False)
    with pytest.raises(InputError, match=r"clip 'walk' holds other frames than those recorded"):
        check(tmp_path, plan(teacher.rig), rate=RATE, whole=True)


@pytest.mark.parametrize(
    "other",
    [
        lambda walk, turn, reach: [walk, turn],
        lambda walk, turn, reach: [walk, turn, replace(reach, held_out=True)],
        lambda walk, turn, reach: [walk, turn, replace(reach, wanted=frozenset(range(10)))],
        lambda walk, turn, reach: [walk, turn, replace(reach, whole=frozenset({2}))],
        lambda walk, turn, reach: [walk, turn, replace(reach, clip=reach.clip.cut(slice(10)))],
    ],
)
def test_the_recording_of_another_plan_is_found(written: Path, other: Callable[..., list[PlannedClip]]) -> None:
    with pytest.raises(InputError):
        check(written, other(*plan(synthetic_rig())), rate=RATE, whole=True)
