"""The two options that every command has: --version and --quiet."""

import functools
import inspect
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Annotated, Any

import typer

import mua


def _print_version(wanted: bool) -> None:
    """Print name and version and stop, before anything else is asked for."""
    if wanted:
        print(f"{command_name()} {mua.__version__}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", is_eager=True, callback=_print_version, help="Print the version and exit.")
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print errors only.")]


def command_name() -> str:
    """What the user has called, such as mua-bake; also where it is run as a module."""
    return f"mua-{Path(sys.argv[0]).stem.removeprefix('mua-')}"


def with_common_options(command: Callable[..., None]) -> Callable[..., None]:
    """The same command with --version and --quiet after its own options."""

    @functools.wraps(command)
    def run(*, version: bool, quiet: bool, **given: Any) -> None:
        if not quiet:
            command(**given)
            return
        with _silence():
            command(**given)

    own = inspect.signature(command, eval_str=True)
    added = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=False, annotation=kind)
        for name, kind in (("version", Version), ("quiet", Quiet))
    ]
    run.__signature__ = own.replace(parameters=[*own.parameters.values(), *added])  # type: ignore[attr-defined]
    run.__annotations__ = {**command.__annotations__, "version": Version, "quiet": Quiet}
    return run


@contextmanager
def _silence() -> Iterator[None]:
    """Nothing that is printed inside is seen; an error that leaves is printed outside."""
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
        yield
