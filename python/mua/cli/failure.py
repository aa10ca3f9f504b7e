"""How every command ends on bad input: one sentence on standard error and exit status 1."""

import sys
from collections.abc import Callable

import typer

from mua.errors import InputError


def refusing(command: Callable[..., None]) -> None:
    """Run a typer command; an InputError becomes its sentence."""
    try:
        typer.run(command)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
