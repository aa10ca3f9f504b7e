"""Two commands at work in one place, the second started at any moment of the first: ten pairs each."""

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from trainings import process

PAIRS = 10
BUSY = "is using it; wait until that has ended, or choose another directory"
BAKE = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from small_bakes import SMALL
from silent import Silent
from mua.baking.settings import BakeSettings
from mua.baking.pipeline import bake
from mua.errors import InputError
settings = BakeSettings(Path(sys.argv[2]), Path(sys.argv[3]), SMALL, "cpu", jobs=2)
try:
    bake(settings, Silent())
except InputError as error:
    sys.exit(str(error))
"""

pytestmark = pytest.mark.long


@dataclass(frozen=True)
class Pair:
    """A first and a second command, when both have ended."""

    directory: Path
    statuses: tuple[int, int]
    errors: tuple[str, str]  # what each wrote to standard error


def pairs(directory: Path, command: Callable[[Path, int], list[str]]) -> Iterator[Pair]:
    """Start pairs of `command(directory, 0 or 1)`, at random within the time that the longest pair has taken so far."""
    moments, seconds = np.random.default_rng(4), 0.0
    for number in range(PAIRS):
        own = directory / str(number)
        own.mkdir()
        started, both = time.monotonic(), []
        for which in range(2):
            time.sleep(moments.uniform(0, seconds) if which else 0)
            both.append(
                subprocess.Popen(command(own, which), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
            )
        errors = tuple(one.communicate()[1] for one in both)
        seconds = max(seconds, time.monotonic() - started)
        yield Pair(own, (both[0].returncode, both[1].returncode), (errors[0], errors[1]))


def one_ends_and_the_other_is_refused_or_ends(pair: Pair) -> bool:
    """Whoever comes second either waits for nothing, where the first has ended, or is refused with who is at work."""
    ends = [
        status == 0 or (status == 1 and BUSY in error) for status, error in zip(pair.statuses, pair.errors, strict=True)
    ]
    return all(ends) and 0 in pair.statuses


def leftovers(directory: Path) -> list[Path]:
    return [path for path in directory.rglob("*") if ".part" in path.name]


def bake(output: Path, work: Path) -> list[str]:
    return [sys.executable, "-c", BAKE, str(Path(__file__).parents[1] / "fixtures"), str(output), str(work)]


@pytest.fixture(scope="module")
def baked(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """What a bake alone ends in."""
    directory = tmp_path_factory.mktemp("alone")
    subprocess.run(bake(directory / "a.muaavatar", directory / "work"), check=True)
    return (directory / "a.muaavatar").read_bytes()


def test_of_two_bakes_in_one_work_directory_one_is_refused_and_one_ends_as_alone(baked: bytes, tmp_path: Path) -> None:
    for pair in pairs(tmp_path, lambda own, _: bake(own / "a.muaavatar", own / "work")):
        assert one_ends_and_the_other_is_refused_or_ends(pair), pair
        assert (pair.directory / "a.muaavatar").read_bytes() == baked
        assert leftovers(pair.directory) == []


def test_two_bakes_of_one_output_end_as_alone(baked: bytes, tmp_path: Path) -> None:
    for pair in pairs(tmp_path, lambda own, which: bake(own / "a.muaavatar", own / f"work {which}")):
        assert pair.statuses == (0, 0), pair
        assert (pair.directory / "a.muaavatar").read_bytes() == baked
        assert leftovers(pair.directory) == []


def test_of_two_trainings_in_one_work_directory_one_is_refused_and_one_ends_as_alone(
    written: Path, tmp_path: Path
) -> None:
    alone = tmp_path / "alone.muaavatar"
    subprocess.run(process(written, alone), check=True, stdout=subprocess.DEVNULL)
    for pair in pairs(tmp_path, lambda own, _: process(written, own / "alone.muaavatar")):
        assert one_ends_and_the_other_is_refused_or_ends(pair), pair
        assert (pair.directory / "alone.muaavatar").read_bytes() == alone.read_bytes()
        assert leftovers(pair.directory) == []
