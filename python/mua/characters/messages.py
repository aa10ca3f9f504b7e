"""What a reader leaves out or changes, as one sentence for each kind of thing."""

from collections.abc import Sequence

UNHELD = "Meshes that no joint moves are left out: {}."
STILL = (
    "Nothing in the file is skinned, so that what moves is taken for the figure; most meshes stand still and are left "
    "out: {}."
)
LOST = (
    "Textures that are neither in the file nor beside it nor in its folder textures/, so that the parts they cover are "
    "drawn in one colour (put them beside the file): {}."
)
PLAIN = (
    "The whole character is drawn in one colour: its surface has texture coordinates, but no material has a picture. "
    "Export it again with its textures, if it should have some. Materials: {}."
)
FIGURES = (
    "The file holds figures that stand side by side on skeletons of their own, and they become one avatar; "
    "--leave-out NAME leaves one out. Beside the largest: {}."
)
STRAY = (
    "Vertices lie so far away that the figure is tiny beside them; delete them in Blender, or leave out their mesh "
    "with --leave-out: {}."
)
LOOKS_WRONG = (STILL, LOST, PLAIN, FIGURES, STRAY)  # what anybody should look at before a bake
SHOWN = 8  # names that a sentence lists before it counts the rest


def is_about(note: str, sentence: str) -> bool:
    """Whether a note is this sentence with some names."""
    return note.startswith(sentence.partition("{")[0])


class Messages:
    """Sentences with {} for the names that each of them is about."""

    def __init__(self) -> None:
        self._names: dict[str, list[str]] = {}

    def add(self, sentence: str, name: str) -> None:
        """Add `name` to `sentence`; a name counts once."""
        names = self._names.setdefault(sentence, [])
        if name not in names:
            names.append(name)

    def sharpen(self, sentence: str, other: str, *, beyond: int) -> None:
        """Say `other` in place of `sentence` where that has more names than `beyond`."""
        if len(self._names.get(sentence, ())) > beyond:
            self._names[other] = self._names.pop(sentence)

    def notes(self) -> tuple[str, ...]:
        """The sentences in the order in which they came up."""
        return tuple(sentence.format(listed(names)) for sentence, names in self._names.items())


def listed(names: Sequence[str]) -> str:
    """Names as an enumeration: the first eight, and how many there are beyond."""
    shown = ", ".join(names[:SHOWN])
    return shown if len(names) <= SHOWN else f"{shown} and {len(names) - SHOWN} more"
