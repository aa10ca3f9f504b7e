"""mua-pack: the same avatar with its numbers stored in another way: smaller for the network, or as they were."""

from pathlib import Path
from typing import Annotated

import typer

from mua.asset.read import decode_tree, load
from mua.asset.summary import storage_of
from mua.asset.tensors import Storage
from mua.asset.write import write
from mua.cli.console import printer, say
from mua.cli.failure import run_command
from mua.errors import InputError
from mua.files.inputs import require_file
from mua.files.write import require_writable

LEAST, MOST = 1 / 16, 16.0  # rounding


def pack(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Avatar file (.muaavatar).")],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="File to write.", show_default="FILE's name with the storage behind it"),
    ] = None,
    storage: Annotated[Storage, typer.Option(help="How numbers are stored; packed is the smallest.")] = "packed",
    rounding: Annotated[
        float,
        typer.Option(min=LEAST, max=MOST, help="How coarsely packed rounds numbers: 2 is smaller, 0.5 nearer to FILE."),
    ] = 1.0,
) -> None:
    """Compress the avatar in FILE for download: a fifth of the bytes, no visible loss."""
    if rounding != 1 and storage != "packed":
        raise InputError(f"--rounding {rounding:g}: only applies to --storage packed, not to {storage}")
    require_file(file)
    target = output or file.with_name(f"{file.stem}_{storage}{file.suffix}")
    if target.exists() and target.samefile(file):
        raise InputError(f"-o is {target}; that is FILE itself; give another name")
    require_writable(target)
    tree = load(file)
    if storage_of(tree) == storage:
        raise InputError(f"{file}: its storage is {storage} already")
    write(target, decode_tree(tree), storage=storage, rounding=rounding)
    before, after = file.stat().st_size, target.stat().st_size
    say(printer(), f"{target}: {after / 1e6:.2f} MB, {file.name}: {before / 1e6:.2f} MB")


def run() -> None:
    """Entry point of the command."""
    run_command(pack)


if __name__ == "__main__":
    run()
