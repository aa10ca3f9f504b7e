"""Ends a command on bad input: one sentence on standard error and exit status 1."""

import sys
from collections.abc import Callable
from typing import NoReturn

import typer

from mua.cli.options import command_name, with_common_options
from mua.errors import InputError
from mua.extras import missing_package


def run_command(command: Callable[..., None]) -> None:
    """Run a command with the arguments of its command line.

    An InputError, or a package that is not installed, ends it with one sentence.
    """
    try:
        app = typer.Typer()  # adds --install-completion and --show-completion
        app.command()(with_common_options(command))
        app(prog_name=command_name())
    except InputError as error:
        _end(str(error))
    except ModuleNotFoundError as error:
        sentence = missing_package(command_name(), error.name or "")
        if sentence is None:
            raise
        _end(sentence)


def _end(sentence: str) -> NoReturn:
    print(f"error: {sentence}", file=sys.stderr)
    sys.exit(1)
