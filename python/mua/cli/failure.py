"""Ends a command on bad input: one sentence on standard error and exit status 1."""

import inspect
import io
import sys
from collections.abc import Callable
from typing import NoReturn

import typer

from mua.cli.options import command_name, with_common_options, with_version
from mua.errors import InputError
from mua.extras import missing_package


def run_command(command: Callable[..., None]) -> None:
    """Run a command with the arguments of its command line.

    An InputError, or a package that is not installed, ends it with one sentence.
    """
    app = typer.Typer()  # adds --install-completion and --show-completion
    app.command(help=_prose(command))(with_common_options(command))
    _run(app)


def run_commands(about: str, *commands: Callable[..., None]) -> None:
    """Run the one of several commands that the command line names first; `about` is the help of them all."""
    app = typer.Typer()
    app.callback(help=about)(with_version)
    for command in commands:
        app.command(help=_prose(command))(with_common_options(command))
    _run(app)


def _prose(command: Callable[..., None]) -> str:
    """The docstring of a command with each paragraph on one line, which the terminal breaks at its own width."""
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in (inspect.getdoc(command) or "").split("\n\n"))


def _run(app: typer.Typer) -> None:
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # names that the console's encoding lacks
    try:
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
