"""mua-inspect: what a `.muaavatar` file holds, and whether it is sound."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from mua.arguments import amount
from mua.asset.read import decode_tree, load
from mua.asset.summary import summary
from mua.cli.console import figures, printer
from mua.cli.failure import run_command
from mua.errors import InputError
from mua.files.inputs import require_file


def inspect(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Avatar file (.muaavatar).")],
    verify: Annotated[
        bool, typer.Option("--verify", help="Only check the file: exit status 0 if it is sound, else 1 and the reason.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON instead of tables, with all joint names.")
    ] = False,
) -> None:
    """Show what FILE holds: skeleton, texels, ranks, size of each part, parameters, GFLOPs and clips."""
    if verify and as_json:
        raise InputError("--json and --verify are both given; expected one of the two")
    require_file(file)
    tree = load(file)
    held = summary(file, tree, decode_tree(tree))
    console = printer()
    if verify:
        console.print(f"{file}: sound, format {held['format']}", highlight=False, soft_wrap=True)
    elif as_json:
        typer.echo(json.dumps(held, indent=1))
    else:
        console.print(_whole(held), _bytes(held), _costs(held), _clips(held))


def run() -> None:
    """Entry point of the command."""
    run_command(inspect)


def _whole(held: dict[str, Any]) -> Table:
    table = Table("", escape(held["name"]), title=escape(held["file"]))
    skeleton, descriptor, texels = held["skeleton"], held["descriptor"], held["texels"]
    template, wavelet = held["template"], held["wavelet"]
    moved = f", {len(descriptor['translated'])} of them translated" if descriptor["translated"] else ""
    rows = {
        "format": f"{held['format']}, {held['storage']}, metres, Y up, right-handed",
        "producer": held["producer"],
        "notes": held["notes"],
        "skeleton": f"{amount(len(skeleton['joints']), 'joint')}, root {skeleton['root']}",
        "descriptor": f"{descriptor['numbers']} numbers: {amount(descriptor['frames'], 'frame')} at "
        f"{descriptor['rate']:g} a second, root and {amount(len(descriptor['joints']), 'joint')}{moved}, "
        f"{'heading removed' if descriptor['heading_removed'] else 'world heading'}",
        "template": f"{template['vertices']} vertices, {template['triangles']} triangles, "
        f"{amount(template['pca_components'], 'PCA component')}",
        "expressions": f"{len(held['expressions'])}: {', '.join(held['expressions'])}"
        if held["expressions"]
        else "none",
        "expressions' rules": ", ".join(held["ruled_expressions"]) or "none",
        "texels": f"{texels['used']} of {texels['side']} x {texels['side']}",
        "wavelet": f"{wavelet['name']}, {amount(wavelet['levels'], 'level')}",
        "geometry ranks": " ".join(map(str, held["ranks"]["geometry"])),
        "appearance ranks": " ".join(map(str, held["ranks"]["appearance"])),
    }
    for name, value in rows.items():
        table.add_row(name, escape(value))
    return table


def _bytes(held: dict[str, Any]) -> Table:
    unpacked = held["unpacked_bytes_by_part"] if held["storage"] == "packed" else {}
    table = figures("part", "bytes", *(["unpacked"] if unpacked else []), title=f"{held['bytes'] / 1e6:.2f} MB")
    for part, size in held["bytes_by_part"].items():
        table.add_row(part, f"{size:,}", *([f"{unpacked[part]:,}"] if unpacked else []))
    return table


def _costs(held: dict[str, Any]) -> Table:
    kept, spent = held["parameters"], held["flops_per_frame"]
    total, cost = sum(kept.values()), sum(spent.values())
    table = figures(
        "part", "parameters", "MFLOPs a frame", title=f"{total / 1e6:.2f} M parameters, {cost / 1e9:.3f} GFLOPs"
    )
    for name in dict.fromkeys([*kept, *spent]):
        shown = f"{kept[name]:,}" if name in kept else ""
        table.add_row(name, shown, f"{spent[name] / 1e6:.1f}" if name in spent else "")
    return table


def _clips(held: dict[str, Any]) -> Table | str:
    if not held["clips"]:
        return "It holds no clips."
    table = figures("clip", "frames", "a second", "seconds")
    for clip in held["clips"]:
        table.add_row(escape(clip["name"]), str(clip["frames"]), f"{clip['rate']:g}", f"{clip['seconds']:.1f}")
    return table


if __name__ == "__main__":
    run()
