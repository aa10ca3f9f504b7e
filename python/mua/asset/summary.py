"""What a `.muaavatar` file holds, as numbers and names: all that mua-inspect shows, as a table or as JSON."""

from pathlib import Path
from typing import Any

from mua.asset.avatar import Avatar
from mua.asset.count import flops, parameters, stored_bytes, unpacked_bytes
from mua.asset.flatbuffer import Tree
from mua.asset.packing import tensors
from mua.rig.expressions import Expressions

PARTS = (
    "skeleton",
    "encoding",
    "template",
    "texels",
    "coarse",
    "geometry",
    "appearance",
    "clips",
    "thumbnail",
    "surface",
    "expressions",
)


def summary(
    path: Path,
    tree: Tree,  # of the file
    avatar: Avatar,  # of the tree
) -> dict[str, Any]:
    """Numbers are in SI units, bytes and operations; the names are those that docs/inspect.md lists."""
    return {
        "file": str(path),
        "bytes": path.stat().st_size,
        "format": f"{tree['version_major']}.{tree['version_minor']}",
        "storage": storage_of(tree),
        "name": avatar.name,
        "producer": avatar.producer,
        "notes": avatar.notes,
        "skeleton": _skeleton(avatar),
        "descriptor": _descriptor(avatar),
        "template": {
            "vertices": len(avatar.rig.mesh.vertices),
            "triangles": len(avatar.rig.mesh.faces),
            "pca_components": len(avatar.coarse.basis),
        },
        "texels": {"used": len(avatar.rig.texels.texels), "side": avatar.rig.texels.size},
        "wavelet": {"name": avatar.wavelet.name, "levels": avatar.wavelet.levels},
        "ranks": {"geometry": list(avatar.geometry.ranks), "appearance": list(avatar.appearance.ranks)},
        "bytes_by_part": {part: stored_bytes(tree.get(part)) for part in PARTS},
        "unpacked_bytes_by_part": {part: unpacked_bytes(tree.get(part)) for part in PARTS},
        "parameters": parameters(avatar),
        "flops_per_frame": flops(avatar),
        "expressions": list(avatar.expressions),
        "ruled_expressions": _ruled(avatar.rig.expressions),
        "clips": [
            {"name": clip.name, "frames": len(clip), "rate": clip.rate, "seconds": len(clip) / clip.rate}
            for clip in avatar.clips
        ],
    }


def storage_of(tree: Tree) -> str:
    """The storage that a loaded file was written with: packed, or the element type of bases and weights."""
    if any("_stored" in tensor for _, tensor in tensors(tree)):
        return "packed"
    return str(tree["geometry"]["ll_basis"]["type"].lower())


def _ruled(expressions: Expressions | None) -> list[str]:
    if expressions is None or expressions.rules is None:
        return []
    return [name for name, rule in zip(expressions.names, expressions.rules, strict=True) if rule]


def _skeleton(avatar: Avatar) -> dict[str, Any]:
    skeleton = avatar.rig.skeleton
    return {"joints": list(skeleton.names), "root": skeleton.names[skeleton.root]}


def _descriptor(avatar: Avatar) -> dict[str, Any]:
    encoding, names = avatar.encoding, avatar.rig.skeleton.names
    return {
        "numbers": encoding.width,
        "frames": encoding.window,
        "rate": encoding.rate,
        "joints": [names[joint] for joint in encoding.joints],
        "translated": [names[joint] for joint in encoding.translated],
        "heading_removed": bool(encoding.remove_heading),
        "components": len(avatar.components.margins),
    }
