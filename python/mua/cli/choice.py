"""Options with a list of choices, which help shows and shells complete; the command itself refuses other values."""

from collections.abc import Sequence
from typing import Any

import typer


def choice(names: Sequence[str], *flags: str, help: str, default: str | bool = True, several: bool = False) -> Any:
    """An option whose value is one of `names`; where it may come several times, its help lists them."""
    listing = f"{help}: {', '.join(names)}." if several else help
    metavar = "NAME" if several else f"<{'|'.join(names)}>"
    return typer.Option(
        *flags,
        metavar=metavar,
        help=listing,
        show_default=default,
        autocompletion=lambda incomplete: _begun(names, incomplete),
    )


def _begun(names: Sequence[str], incomplete: str) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]
