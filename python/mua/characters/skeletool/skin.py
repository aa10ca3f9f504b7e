"""Skeletool's .skin: the bones of a character, and which of them carry each vertex."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.skeletool.lines import SKIN, Line, Lines
from mua.characters.skeletool.skeleton import DofSkeleton
from mua.errors import InputError


@dataclass(frozen=True, eq=False)
class BoneWeights:
    """The bones that carry V vertices, and their weights."""

    bones: tuple[str, ...]
    joints: tuple[int, ...]  # of the skeleton, by bone: it ends there
    indices: Array  # [V, K] int into bones
    weights: Array  # [V, K] >= 0; 0 where a vertex has fewer than K


def read_skin(path: Path, skeleton: DofSkeleton, vertices: int) -> BoneWeights:
    """Read the weights of that many vertices; raises InputError that names the line where they are not."""
    lines = Lines(path, SKIN)
    _title(lines, "bones:")
    named = lines.next("the names of the bones")
    bones, joints = named.words, [skeleton.joint_of(bone) for bone in named.words]
    for bone, joint in zip(bones, joints, strict=True):
        if joint is None:
            raise named.error(f"bone {bone!r} is no joint of the skeleton")
        if joints.count(joint) > 1:
            raise named.error(f"bone {bone!r} is named twice")
    _title(lines, "vertex weights:")
    rows = [_influences(line, v, len(bones)) for v, line in enumerate(lines)]
    if len(rows) != vertices:
        raise InputError(f"{path}: has weights of {len(rows)} vertices, expected the {vertices} of the mesh")
    most = max(len(row) for row in rows)
    padded = np.array([np.pad(row, ((0, most - len(row)), (0, 0))) for row in rows])
    found = tuple(joint for joint in joints if joint is not None)
    return BoneWeights(bones, found, padded[..., 0].astype(int), padded[..., 1])


def _title(lines: Lines, title: str) -> None:
    line = lines.next(f"{title!r}")
    if " ".join(line.words) != title:
        raise line.error(f"{' '.join(line.words)[:40]!r}, expected {title!r}")


def _influences(line: Line, vertex: int, bones: int) -> Array:
    """Bone and weight [K, 2] of a vertex."""
    values = line.numbers(0)
    if values[0] != vertex:
        raise line.error(f"is about vertex {line.words[0]}, expected {vertex}")
    if len(values) < 3 or len(values) % 2 == 0:
        raise line.error(f"has {len(values) - 1} numbers after the vertex, expected pairs of bone and weight")
    pairs = values[1:].reshape(-1, 2)
    for bone, weight in pairs:
        if bone not in range(bones):
            raise line.error(f"bone {bone:g}, expected 0 to {bones - 1}")
        if weight < 0:
            raise line.error(f"weight {weight:g} of bone {bone:g}, expected at least 0")
    if not pairs[:, 1].any():
        raise line.error("all weights are 0")
    return pairs
