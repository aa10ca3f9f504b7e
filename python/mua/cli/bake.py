"""mua-bake: a rigged character and its motion become a verified `.muaavatar`."""

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from mua.baking.bake import bake as mua_bake
from mua.baking.bake import read_settings
from mua.characters.formats import named_characters
from mua.cli.console import printer
from mua.cli.failure import run_command
from mua.cli.options import command_options, lent_by
from mua.errors import InputError
from mua.files.inputs import is_capture

PANELS = {
    "Character": (
        *("scale", "height", "facing", "turn", "leave_out", "alpha"),
        *("expression_names", "smplx", "uv", "detail"),
    ),
    "Motion": ("face", "mapping", "feet", "motion_range", "hold_out", "clips"),
    "Training": ("frames", "texels", "recipe", "storage", "seed", "device", "jobs", "work"),
}


@lent_by(mua_bake, command_options(mua_bake, PANELS))
def main(
    *,
    more: Annotated[
        list[Path] | None, typer.Argument(metavar="MORE", help="With --check: more characters, or folders of them.")
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Train nothing; in seconds, compare splats and motion with their sources.")
    ] = False,
    verbose: Annotated[
        bool, typer.Option("--verbose", help="Print lists in full; with --check, picture every expression.")
    ] = False,
    json: Annotated[Path | None, typer.Option(help="With --check: JSON file to write all figures to.")] = None,
    **options: Any,
) -> None:
    """Bake a rigged character and its motion into a .muaavatar file.

    A table of errors and a contact sheet are written beside it. To resume an interrupted run, give the same command
    again.
    """
    try:
        _bake(options, more or [], check=check, json=json, verbose=verbose)
    except InputError as error:
        if verbose:
            raise error.in_full() from error
        raise


def _bake(options: dict[str, Any], more: list[Path], *, check: bool, json: Path | None, verbose: bool) -> None:
    if json is not None and not check:
        raise InputError("--json: only --check writes it; expected --check too")
    given = [path for path in (options["character"], *more) if path is not None]
    several = bool(more) or (check and given[:1] and given[0].is_dir() and not is_capture(given[0]))
    if several and not check:
        motions = "; each motion file needs a --motion of its own" if options["motion"] else ""
        raise InputError(f"{given[1]}: one character is baked at a time; only --check takes several{motions}")
    characters = named_characters(given) if several else []
    settings = read_settings(options | {"character": None} if several else options)
    if check and (settings.teacher or settings.training):
        raise InputError("--check: compares a character with its file; look at a capture with mua-capture check")
    if check:
        from mua.cli.check import check_and_show, check_many_and_show

        if several:
            check_many_and_show(settings, characters, json)
        else:
            check_and_show(settings, json, verbose=verbose)
        return

    alone = "torch" not in sys.modules  # else its threads may have started, which do not survive a fork
    from mua.baking.pipeline import bake  # after the options are checked, because it takes seconds to load
    from mua.cli.display import Display, show

    console = printer()
    with Display(console, verbose=verbose) as display:
        baked = bake(settings, display, alone=alone)
    show(console, baked)


def run() -> None:
    """Entry point of the command."""
    run_command(main)


if __name__ == "__main__":
    run()
