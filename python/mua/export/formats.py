"""The content of the requested files; libraries are loaded for the formats that need them."""

from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from mua.arguments import amount
from mua.avatar.decode import Splats
from mua.export.compressed_ply import compressed_ply_bytes
from mua.export.frames import ExportFrames
from mua.export.kinds import GEOMETRY, MESH, PACKAGE, SPLATS, USD, Kind
from mua.export.ply import ply_bytes
from mua.export.splats import HALF_TURN_Z, WorldSplats, turned, world_splats
from mua.export.spz import spz_bytes

# Viewers assume Y down in these formats, as 3D Gaussian Splatting writes them.
SPLAT_FORMATS: dict[str, Callable[[WorldSplats], bytes]] = {
    ".ply": ply_bytes,
    ".compressed.ply": compressed_ply_bytes,
    ".spz": spz_bytes,
}


def frame_content(kind: Kind, frames: ExportFrames, number: int, *, down: bool) -> bytes:
    """The content of the file of one frame; its splats with Y `down` or up."""
    splats, name = frames.splats(number), f"{frames.avatar.name}_{number}"
    if kind.what == GEOMETRY:
        from mua.export.character_glb import geometry_glb
        from mua.export.surface import detailed_mesh

        return geometry_glb(splats, detailed_mesh(frames.avatar), name=name)
    shown = world_splats(splats)
    shown = turned(shown, HALF_TURN_Z) if down else shown
    if kind.suffix == ".glb":
        from mua.export.splat_glb import splat_glb

        return splat_glb(shown, name=name)
    return SPLAT_FORMATS[kind.suffix](shown)


def write_clip(kind: Kind, path: Path, frames: ExportFrames, posed: Iterator[Splats]) -> None:
    """Write the file of all frames; `posed` are their splats, which not every format looks at."""
    if kind.suffix == ".bvh":
        from mua.export.bvh import bvh_text

        path.write_text(bvh_text(frames.avatar.rig.skeleton, frames.poses))
    elif kind.suffix in USD:
        _write_usd(kind, path, frames, posed)
    else:
        from mua.export.character_glb import character_glb
        from mua.export.surface import skinned_mesh

        mesh = skinned_mesh(frames.avatar, next(posed)) if kind.what == MESH else None
        path.write_bytes(character_glb(frames, mesh))


def _write_usd(kind: Kind, path: Path, frames: ExportFrames, posed: Iterator[Splats]) -> None:
    from mua.export import usd

    if kind.suffix != PACKAGE:
        _write_stage(kind, path, frames, posed, texture=None)
        return
    with TemporaryDirectory(prefix="mua-export.") as directory:
        stage = Path(directory) / "avatar.usdc"
        _write_stage(kind, stage, frames, posed, texture="texture.png")
        usd.package(path, stage)


def _write_stage(
    kind: Kind,
    path: Path,
    frames: ExportFrames,
    posed: Iterator[Splats],
    *,
    texture: str | None,  # name of the image to write beside the stage
) -> None:
    from mua.export import usd
    from mua.export.surface import detailed_mesh, skinned_mesh

    if kind.what == GEOMETRY:
        usd.write_geometry(path, frames, posed, detailed_mesh(frames.avatar))
    elif kind.what == SPLATS:
        usd.write_splats(path, frames, posed)
    elif kind.what == MESH:
        mesh = skinned_mesh(frames.avatar, next(posed))
        if texture is not None:
            (path.parent / texture).write_bytes(mesh.png)
        usd.write_character(path, frames, mesh, texture=texture)
    else:
        usd.write_character(path, frames, None)


def held(kind: Kind, frames: ExportFrames) -> str:
    """What a file holds, in words."""
    rig = frames.avatar.rig
    joints = amount(len(rig.skeleton.names), "joint")
    counts = {
        SPLATS: amount(len(rig.texels.texels), "splat"),
        GEOMETRY: f"detailed geometry of {len(rig.texels.texels):,} vertices",
        MESH: f"mesh of {amount(len(rig.mesh.faces), 'triangle')}, {joints}",
    }
    what = counts.get(kind.what, joints)
    return f"{what}, {amount(len(frames.numbers), 'frame')}" if kind.clip else what
