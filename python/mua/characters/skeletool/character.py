"""Skeletool's .character: which files a character is made of; and which character a .motion belongs to."""

from dataclasses import dataclass
from pathlib import Path

from mua.characters.skeletool.lines import CHARACTER, Lines
from mua.errors import InputError

LABELS = ("skeleton", "mesh", "skin", "pose")
SUFFIX = ".character"


@dataclass(frozen=True)
class CharacterFiles:
    """The files that a .character names."""

    skeleton: Path
    mesh: Path
    skin: Path
    pose: Path  # motion whose first frame shows the skeleton as the mesh is


def read_character_files(path: Path) -> CharacterFiles:
    """Read a .character; raises InputError that names what it does not name, or a file that is not there."""
    found: dict[str, Path] = {}
    lines = Lines(path, CHARACTER)
    for label in lines:
        line = lines.next(f"the file of {label.words[0]!r}")
        name = " ".join(line.words)
        found[label.words[0]] = path.parent / name
        if label.words[0] in LABELS and not found[label.words[0]].is_file():
            raise line.error(f"{label.words[0]} is {name!r}: there is no such file beside it")
    for wanted in LABELS:
        if wanted not in found:
            raise InputError(f"{path}: names no {wanted}, expected {', '.join(LABELS)}")
    return CharacterFiles(**{label: found[label] for label in LABELS})


def character_of(motion: Path) -> Path:
    """The .character whose skeleton a .motion moves: the only one beside it, else in the folder above.

    Raises InputError where there is none, or several.
    """
    beside = motion.absolute().parent
    for folder in (beside, beside.parent):
        found = sorted(folder.glob(f"*{SUFFIX}"))
        if len(found) > 1:
            raise InputError(f"{motion}: {folder} holds {found[0].name} and {found[1].name}; expected one character")
        if found:
            return found[0]
    raise InputError(f"{motion}: there is no {SUFFIX} beside it or in the folder above, which names its skeleton")
