"""Where commands print what they found: as wide as the terminal, and as wide as need be where there is none."""

import os

from rich.box import HEAVY_HEAD, Box
from rich.console import Console
from rich.table import Table

MOST_NAMES, FEW_NAMES = 8, 3  # that a sentence lists in full, and that it lists of more
WIDE = 1000  # columns; a table takes what it needs of them


def printer(*, quiet: bool = False, highlight: bool = True) -> Console:
    """A console for standard output. In a pipe or a file no line is broken and no cell cut, unless COLUMNS says how."""
    console = Console(quiet=quiet, highlight=highlight)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = WIDE
    return console


def figures(*heads: str, title: str | None = None, box: Box = HEAVY_HEAD) -> Table:
    """A table of names and, to the right of them, figures."""
    table = Table(*heads, title=title, box=box)
    for column in table.columns[1:]:
        column.justify = "right"
    return table


def brief(sentence: str) -> str:
    """A sentence without the rest of a long list at its end."""
    start, colon, listed = sentence.rpartition(": ")
    names = listed.removesuffix(".").split(", ")
    if not colon or len(names) <= MOST_NAMES:
        return sentence
    return f"{start}: {', '.join(names[:FEW_NAMES])} and {len(names) - FEW_NAMES} more (--verbose lists them)."


def say(console: Console, sentence: str) -> None:
    """Print a sentence as it stands, on one line however long."""
    console.print(sentence, highlight=False, markup=False, soft_wrap=True)
