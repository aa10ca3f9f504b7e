"""mua-share: avatars as a folder for any web host, or as one HTML file."""

from pathlib import Path
from typing import Annotated

import typer

from mua.arguments import amount
from mua.cli.failure import run_command
from mua.errors import InputError
from mua.files.inputs import require_file
from mua.files.write import require_writable, write_bytes

SUFFIX = ".html"


def share(
    files: Annotated[
        list[Path], typer.Argument(metavar="FILES", help="Avatar file (.muaavatar); several stand side by side.")
    ],
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Folder to write; with --single-file an .html file.", show_default=False),
    ] = None,
    title: Annotated[str | None, typer.Option(help="Title of the page.", show_default="the names of the files")] = None,
    clip: Annotated[str | None, typer.Option(help="Clip to begin with.", show_default="the first one")] = None,
    single_file: Annotated[
        bool, typer.Option("--single-file", help="Write one HTML file that holds everything; for small avatars.")
    ] = False,
    reference: Annotated[
        bool, typer.Option("--reference", help="Draw the poster image on the CPU; needs no graphics device.")
    ] = False,
) -> None:
    """Write a page that plays FILES in a browser, with all that it needs."""
    from mua.share.folder import require_replaceable
    from mua.share.single import require_small

    for file in files:
        require_file(file)
    if output is None:
        raise InputError("-o is not given; expected a folder to write, or an .html file with --single-file")
    if single_file:
        if output.suffix.lower() != SUFFIX:
            raise InputError(f"-o is {output}; expected a name that ends in {SUFFIX} with --single-file")
        require_small(files)
        require_writable(output)
    else:
        require_replaceable(output)
    _write(files, output, title=title, clip=clip, single_file=single_file, reference=reference)


def _write(
    files: list[Path], output: Path, *, title: str | None, clip: str | None, single_file: bool, reference: bool
) -> None:
    from mua.share.folder import write_folder
    from mua.share.poster import front, opening, poster
    from mua.share.single import single_page
    from mua.share.site import Shown, player_site, title_of

    openings = [opening(file, clip) for file in files]  # a damaged file is not shared
    more = {"azimuth": f"{front(*openings[0]):.1f}"}
    shown = Shown(title_of(files) if title is None else title, clip, more=more)
    picture = poster(files[0], *openings[0], reference=reference) if len(files) == 1 else None
    if single_file:
        page = single_page(files, shown, poster=picture).encode()
        write_bytes(output, page)
        typer.echo(f"{output}: {len(page) / 1e6:.1f} MB; open it in a browser")
        return
    site = player_site(files, shown, poster=picture)
    write_folder(output, site)
    total = sum(path.stat().st_size for path in output.rglob("*") if path.is_file())
    typer.echo(f"{output}: {amount(len(site), 'file')}, {total / 1e6:.1f} MB; copy it to any web host")


def run() -> None:
    """Entry point of the command."""
    run_command(share)


if __name__ == "__main__":
    run()
