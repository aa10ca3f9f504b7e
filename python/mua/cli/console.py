"""Where commands print what they found: as wide as the terminal, and as wide as need be where there is none."""

import os

from rich.console import Console

WIDE = 1000  # columns; a table takes what it needs of them


def printer(*, quiet: bool = False, highlight: bool = True) -> Console:
    """A console for standard output. In a pipe or a file no line is broken and no cell cut, unless COLUMNS says how."""
    console = Console(quiet=quiet, highlight=highlight)
    if not console.is_terminal and "COLUMNS" not in os.environ:
        console.width = WIDE
    return console


def say(console: Console, sentence: str) -> None:
    """Print a sentence as it stands, on one line however long."""
    console.print(sentence, highlight=False, markup=False, soft_wrap=True)
