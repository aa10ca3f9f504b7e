"""The text files of Skeletool, line by line; every error names file, line and value."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.errors import InputError
from mua.files.signature import require_kind

SHOWN = 40  # letters of a value that a sentence shows
SKELETON = "Skeletool Skeleton Definition V1.0"
SKIN = "Skeletool character skinning file V1.0"
MOTION = "Skeletool Motion File V1.0"
CHARACTER = "skeletool character file v1.0"


@dataclass(frozen=True)
class Line:
    """The words of a line that is not empty."""

    path: Path
    number: int  # from 1
    words: tuple[str, ...]

    def error(self, problem: str) -> InputError:
        """The error whose sentence begins with file and line."""
        return InputError(f"{self.path}, line {self.number}: {problem}")

    def numbers(self, first: int, end: int | None = None) -> Array:
        """Words `first` to `end` as finite numbers; raises InputError at the first that is none."""
        words = self.words[first:end]
        try:
            found = np.array(words, float)
        except ValueError:
            found = np.array([_number(word) for word in words])
        wrong = np.flatnonzero(~np.isfinite(found))
        if len(wrong):
            raise self.error(f"number {wrong[0] + 1} is {words[wrong[0]][:SHOWN]!r}, expected a finite number")
        return found

    def whole(self, word: int) -> int:
        """A word as a whole number of at least 0; raises InputError for any other."""
        if not (self.words[word].isascii() and self.words[word].isdecimal()):
            raise self.error(f"{self.words[word][:SHOWN]!r}, expected a whole number")
        return int(self.words[word])


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")


def read_lines(path: Path) -> list[str]:
    """The lines of a text file; raises InputError where it is not there, or is none."""
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    require_kind(path, "a text file of a Skeletool character", kinds=())
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as text: {error}") from error


class Lines:
    """The lines of a file after its first one, which says what it is; empty lines are skipped."""

    def __init__(self, path: Path, head: str) -> None:
        """Raises InputError where there is no such file, or its first line is not `head`."""
        texts = read_lines(path)
        found = " ".join(texts[0].split()) if texts else ""
        if found.lower() != head.lower():
            raise InputError(f"{path}: the first line is {found[:SHOWN]!r}, expected {head!r}")
        self._path, self._last = path, len(texts)
        numbered = ((number, tuple(text.split())) for number, text in enumerate(texts[1:], 2))
        self._lines = (Line(path, number, words) for number, words in numbered if words)

    def __iter__(self) -> Iterator[Line]:
        return self._lines

    def next(self, expected: str) -> Line:
        """The next line; raises InputError where the file ends before it."""
        line = next(self._lines, None)
        if line is None:
            raise InputError(f"{self._path}: ends after line {self._last}, expected {expected}")
        return line

    def section(self, name: str) -> int:
        """The number in a line such as `joints: 173`; raises InputError for any other line."""
        line = self.next(f"'{name}: N'")
        *words, _ = line.words
        if " ".join(words) != f"{name}:":
            raise line.error(f"{' '.join(line.words)[:SHOWN]!r}, expected '{name}: N'")
        return line.whole(-1)
