"""mua-inspect: what a `.muaavatar` file holds, and whether it is sound."""

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from mua.asset.avatar import Avatar
from mua.asset.count import flops, parameters, stored_bytes
from mua.asset.flatbuffer import Tree
from mua.asset.read import decode_tree, load
from mua.cli.failure import refusing
from mua.cli.inputs import require_file

PARTS = ("skeleton", "encoding", "template", "texels", "coarse", "geometry", "appearance", "clips", "thumbnail")


def inspect(
    file: Annotated[Path, typer.Argument(help="A .muaavatar file.")],
    verify: Annotated[bool, typer.Option(help="Only check the file: exit 0, or 1 with a sentence.")] = False,
) -> None:
    """Print what FILE holds: skeleton, texels, ranks, bytes by part, parameters, GFLOPs and clips."""
    require_file(file)
    tree = load(file)
    avatar = decode_tree(tree)
    console = Console()
    if verify:
        console.print(f"{file}: sound, format {tree['version_major']}.{tree['version_minor']}", highlight=False)
        return
    console.print(_summary(file, tree, avatar), _bytes(file, tree), _costs(avatar), _clips(avatar))


def run() -> None:
    """Entry point of the command."""
    refusing(inspect)


def _summary(file: Path, tree: Tree, avatar: Avatar) -> Table:
    table = Table("", avatar.name, title=str(file))
    texels, encoding, skeleton = avatar.rig.texels, avatar.encoding, avatar.rig.skeleton
    kind = tree["geometry"]["ll_basis"]["type"].lower()
    rows = {
        "format": f"{tree['version_major']}.{tree['version_minor']}, {kind}, metres, Y up, right-handed",
        "producer": avatar.producer,
        "notes": avatar.notes,
        "skeleton": f"{len(skeleton.names)} joints, root {skeleton.names[skeleton.root]}",
        "descriptor": f"{encoding.width} numbers: {encoding.window} frames at {encoding.rate:g} a second, "
        f"root and {len(encoding.joints)} joints, {len(encoding.translated)} translated, "
        f"{'heading removed' if encoding.heading else 'world heading'}",
        "template": f"{len(avatar.rig.mesh.vertices)} vertices, {len(avatar.rig.mesh.faces)} triangles, "
        f"{len(avatar.coarse.basis)} PCA components",
        "texels": f"{len(texels.texels)} of {texels.size} x {texels.size}",
        "wavelet": f"{avatar.wavelet.name}, {avatar.wavelet.levels} levels",
        "geometry ranks": " ".join(map(str, avatar.geometry.ranks)),
        "appearance ranks": " ".join(map(str, avatar.appearance.ranks)),
    }
    for name, value in rows.items():
        table.add_row(name, value)
    return table


def _bytes(file: Path, tree: Tree) -> Table:
    table = Table("part", "bytes", title=f"{file.stat().st_size / 1e6:.2f} MB")
    table.columns[1].justify = "right"
    for part in PARTS:
        table.add_row(part, f"{stored_bytes(tree[part]):,}")
    return table


def _costs(avatar: Avatar) -> Table:
    held, spent = parameters(avatar), flops(avatar)
    total, cost = sum(held.values()), sum(spent.values())
    table = Table(
        "part", "parameters", "MFLOPs a frame", title=f"{total / 1e6:.2f} M parameters, {cost / 1e9:.3f} GFLOPs"
    )
    for name in dict.fromkeys([*held, *spent]):
        shown = f"{held[name]:,}" if name in held else ""
        table.add_row(name, shown, f"{spent[name] / 1e6:.1f}" if name in spent else "")
    return table


def _clips(avatar: Avatar) -> Table:
    table = Table("clip", "frames", "a second", "seconds")
    for clip in avatar.clips:
        table.add_row(clip.name, str(len(clip)), f"{clip.rate:g}", f"{len(clip) / clip.rate:.1f}")
    return table
