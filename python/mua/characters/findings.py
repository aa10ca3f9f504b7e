"""What a reader leaves out or changes, gathered into one sentence for each kind of thing."""

UNHELD = "Meshes that no joint moves are left out: {}."
SHOWN = 8  # names that a sentence lists before it counts the rest


class Findings:
    """Names by the sentence that is told of them; the sentence holds {} where they stand."""

    def __init__(self) -> None:
        self._names: dict[str, list[str]] = {}

    def add(self, sentence: str, name: str) -> None:
        """Tell `sentence` of `name` too; a name that was there already counts once."""
        names = self._names.setdefault(sentence, [])
        if name not in names:
            names.append(name)

    def notes(self) -> tuple[str, ...]:
        """The sentences in the order in which they came up."""
        return tuple(sentence.format(listed(names)) for sentence, names in self._names.items())


def listed(names: list[str]) -> str:
    """Names as an enumeration: the first eight, and how many there are beyond."""
    shown = ", ".join(names[:SHOWN])
    return shown if len(names) <= SHOWN else f"{shown} and {len(names) - SHOWN} more"
