"""The C# reader of avatar files as a program, and what it prints."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csharp import PROGRAMS, RUNTIME, CSharp

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import Tree
from mua.asset.read import decode_tree
from mua.asset.tensors import stored
from mua.avatar.model import Branch, Mlp


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.build([RUNTIME / "Format", PROGRAMS / "FormatProgram.cs"])


CLIP_TENSORS = ("rotations", "translation", "translations", "expressions")


def barycentrics_of(tree: Tree, avatar: Avatar) -> Array:
    """As stored, not yet within 0 to 1, or computed."""
    kept = stored(tree["barycentrics"], "barycentrics")
    if "listed" not in tree:
        return kept
    found = avatar.rig.texels.barycentrics[:, :2].copy()
    found[stored(tree["listed"], "listed")] = kept
    return found


def joints_of(tree: Tree) -> Any:
    return stored(tree["translated"], "translated") if "translated" in tree else ()


def values(tree: Tree) -> dict[str, tuple[str, bytes]]:
    """Kind and bytes of everything that the program dumps."""
    avatar = decode_tree(tree)
    rig, skeleton, encoding, wavelet = avatar.rig, avatar.rig.skeleton, avatar.encoding, avatar.wavelet
    integers: dict[str, Any] = {
        "template.faces": rig.mesh.faces,
        "template.uv_faces": rig.mesh.uv_faces,
        "template.skin_indices": rig.skin_indices,
        "texels.texels": rig.texels.texels,
        "texels.triangles": rig.texels.triangles,
        "texels.size": rig.texels.size,
        "skeleton.parents": skeleton.parents,
        "skeleton.root": skeleton.root,
        "skeleton.translated": joints_of(tree["skeleton"]),
        "encoding.translated": joints_of(tree["encoding"]),
        "encoding.joints": encoding.joints,
        "encoding.window": (encoding.window, encoding.remove_heading),
        "wavelet.levels": wavelet.levels,
    }
    if rig.expressions:
        integers |= {f"expressions.{key}": getattr(rig.expressions, key) for key in ("starts", "vertices")}
    if avatar.surface:
        integers["surface.triangles"] = avatar.surface.triangles(rig.texels)
    floats: dict[str, Any] = {
        "template.uv": rig.mesh.uv,
        "template.skin_weights": rig.skin_weights,
        "texels.barycentrics": barycentrics_of(tree["texels"], avatar),
        "coarse.mean": avatar.coarse.mean,
        "coarse.basis": avatar.coarse.basis,
        "encoding.rate": encoding.rate,
        "encoding.mean": avatar.components.normalization.mean,
        "encoding.scale": avatar.components.normalization.scale,
        "encoding.components": avatar.components.directions,
        "encoding.ranges": avatar.components.ranges,
        "encoding.margins": avatar.components.margins,
        "bounds": avatar.bounds,
        **mlp_values("coarse", avatar.coarse.mlp),
        **branch_values("geometry", avatar.geometry),
        **branch_values("appearance", avatar.appearance),
    }
    if rig.expressions:
        floats["expressions.offsets"] = rig.expressions.offsets
        if rig.expressions.rules is not None:
            integers["expressions.rules"] = rig.expressions.rules
        if rig.expressions.gains is not None:
            floats["expressions.gains"] = rig.expressions.gains
    clips: dict[str, Any] = {f"clips.{i}.rate": clip.rate for i, clip in enumerate(avatar.clips)}
    for i, clip in enumerate(tree["clips"]):  # as stored: rotations not yet of unit length
        clips |= {f"clips.{i}.{key}": stored(clip[key], key) for key in CLIP_TENSORS if key in clip}
    doubles: dict[str, Any] = {
        "skeleton.bind_rotations": skeleton.bind_rotations,
        "skeleton.bind_translations": skeleton.bind_translations,
        "skeleton.bind_inverse": skeleton.bind_inverse,
        "wavelet.rec_lo": wavelet.rec_lo,
        "wavelet.rec_hi": wavelet.rec_hi,
    }
    texts = {
        "name": avatar.name,
        "producer": avatar.producer,
        "notes": avatar.notes,
        "wavelet.name": wavelet.name,
        "skeleton.names": "\n".join(skeleton.names),
        **{f"clips.{i}.name": clip.name for i, clip in enumerate(avatar.clips)},
        **({"expressions.names": "\n".join(rig.expressions.names)} if rig.expressions else {}),
    }
    return {
        **{name: ("i4", np.asarray(value, "<i4").tobytes()) for name, value in integers.items()},
        **{name: ("f4", np.asarray(value, "<f4").tobytes()) for name, value in (floats | clips).items()},
        **{name: ("f8", np.asarray(value, "<f8").tobytes()) for name, value in doubles.items()},
        **{name: ("text", value.encode()) for name, value in texts.items()},
        "thumbnail": ("u1", avatar.thumbnail),
        **{
            f"texels.{name}": ("u1", tree["texels"][name].tobytes())
            for name in ("one_sided",)
            if name in tree["texels"]
        },
    }


def mlp_values(name: str, mlp: Mlp) -> dict[str, Array]:
    weights = {f"{name}.mlp.{i}.weight": layer.weight for i, layer in enumerate(mlp)}
    return weights | {f"{name}.mlp.{i}.bias": layer.bias for i, layer in enumerate(mlp)}


def branch_values(name: str, branch: Branch) -> dict[str, Array]:
    bands = {
        f"{name}.details.{i}.{part}": getattr(band, part)
        for i, band in enumerate(branch.details)
        for part in ("mean", "h", "w")
    }
    parts = {"ll_mean": branch.ll_mean, "ll_basis": branch.ll_basis, "static_offset": branch.static}
    return mlp_values(name, branch.mlp) | bands | {f"{name}.{part}": value for part, value in parts.items()}
