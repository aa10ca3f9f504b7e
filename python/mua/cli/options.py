"""The two options that every command has, --version and --quiet; those that are a function's arguments; choices."""

import functools
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

import typer

from mua.option import Option, declared, takes_numbers, takes_path, takes_several
from mua.version import __version__


def _print_version(wanted: bool) -> None:
    """Print name and version and stop, before anything else is asked for."""
    if wanted:
        print(f"{command_name()} {__version__}")
        raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", is_eager=True, callback=_print_version, help="Print the version and exit.")
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print errors only.")]


def command_name() -> str:
    """What the user has called, such as mua-bake; also where it is run as a module."""
    return f"mua-{Path(sys.argv[0]).stem.removeprefix('mua-')}"


def with_common_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --version and --quiet after a command's own options."""

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


def with_version(*, version: Version = False) -> None:
    """What a command of several commands can do by itself."""


def command_options(
    function: Callable[..., object],
    panels: Mapping[str, Sequence[str]] | None = None,  # title in --help to the names of its options
) -> dict[str, Any]:
    """What a terminal takes for each option that a public function declares, as typer has it."""
    titles = {name: title for title, names in (panels or {}).items() for name in names}
    return {
        argument.name: Annotated[_typed(argument, kind, option), _described(argument, kind, option, titles)]
        for argument, kind, option in declared(function)
    }


def _typed(argument: inspect.Parameter, kind: Any, option: Option) -> Any:
    """The type of a terminal's value; an argument without a name is a path."""
    if takes_several(kind):
        return {"path": list[Path], "float": list[float], "str": list[str]}[_element(kind)]
    if argument.kind is argument.POSITIONAL_OR_KEYWORD or takes_path(kind):
        return Path if argument.default is argument.empty or argument.default is not None else Path | None
    return str if option.choices else kind


def _element(kind: Any) -> str:
    """What --help calls one value of an option that may be repeated."""
    return "path" if takes_path(kind) else "float" if takes_numbers(kind) else "str"


def _described(argument: inspect.Parameter, kind: Any, option: Option, titles: Mapping[str, str]) -> Any:
    """Typer's own declaration of an option."""
    if argument.kind is argument.POSITIONAL_OR_KEYWORD:
        return typer.Argument(help=option.help, show_default=option.default, metavar=option.metavar)
    name = f"--{argument.name.replace('_', '-')}"
    if option.choices:
        described = choice(option.choices, name, help=option.help, several=takes_several(kind))
    else:
        flags = [name, option.short] if option.short else [name] if argument.default is False else []
        metavar = f"<{_element(kind)}>" if takes_several(kind) else None
        described = typer.Option(*flags, help=option.help, show_default=option.default, metavar=metavar)
    described.rich_help_panel = titles.get(argument.name)
    return described


def lent_by(
    function: Callable[..., object],
    kinds: Mapping[str, Any],  # by argument: the type that a terminal takes, with its help
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command the arguments of a function, by the names and defaults that they have there."""
    arguments = inspect.signature(function).parameters
    keyword = inspect.Parameter.KEYWORD_ONLY
    lent = [
        inspect.Parameter(name, keyword, default=_for_terminal(arguments[name].default, kind), annotation=kind)
        for name, kind in kinds.items()
    ]

    def lend(command: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(command, eval_str=True)
        own = [each.replace(kind=keyword) for each in signature.parameters.values() if each.kind != each.VAR_KEYWORD]

        @functools.wraps(command)
        def run(**given: Any) -> None:
            bound = joined.bind(**given)
            bound.apply_defaults()
            command(**bound.arguments)

        joined = inspect.Signature([*lent, *own])
        run.__signature__ = joined  # type: ignore[attr-defined]
        run.__annotations__ = {each.name: each.annotation for each in joined.parameters.values()}
        return run

    return lend


def _for_terminal(default: Any, kind: Any) -> Any:
    """A default as typer takes it: that of an option which may be repeated is a list."""
    if get_origin(get_args(kind)[0]) is not list or default is inspect.Parameter.empty:
        return default
    return [default] if isinstance(default, str) else list(default)


@contextmanager
def _silence() -> Iterator[None]:
    """Nothing that is printed inside is seen; an error that leaves is printed outside."""
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
        yield


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
