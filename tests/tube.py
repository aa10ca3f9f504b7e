"""A small character for tests: an upright tube on three joints, its wall one UV chart that is cut along one side."""

import numpy as np
from people import upright

from mua import rotation
from mua.arrays import Array
from mua.pose.clip import Clip
from mua.rig.character import Character, Mesh

HEIGHT, RADIUS = 1.75, 0.12  # metres
RATE = 30.0


def tube(*, rings: int = 29, sides: int = 13, looseness: float | None = None) -> Character:
    """A tube of rings x sides vertices that faces outward, its joints one above the other."""
    joint_heights = np.array([0.05, 0.6, 1.2])
    skeleton = upright(("Hips", "Spine", "Chest"), (-1, 0, 1), [[0, 0.05, 0], [0, 0.55, 0], [0, 0.6, 0]])
    mesh = _wall(rings, sides)
    near = np.exp(-(((mesh.vertices[:, 1:2] - joint_heights - 0.3) / 0.2) ** 2))
    order = np.argsort(-near, axis=1, kind="stable")
    indices, weights = np.zeros((len(near), 8), np.int32), np.zeros((len(near), 8), np.float32)
    indices[:, :3] = order
    weights[:, :3] = np.take_along_axis(near / near.sum(axis=1, keepdims=True), order, axis=1)
    column, row = np.meshgrid(np.arange(64), np.arange(64))
    base_color = np.stack([4 * column, 4 * row, 0 * row + 128, 0 * row + 255], axis=2).astype(np.uint8)
    hanging = None if looseness is None else np.full(len(mesh.vertices), looseness)
    return Character("tube", skeleton, mesh, indices, weights, base_color, looseness=hanging)


def still(character: Character, *, frames: int = 5) -> Clip:
    """The bind pose, held."""
    skeleton = character.skeleton
    rotations = np.tile(skeleton.bind_rotations, (frames, 1, 1))
    return Clip("still", RATE, rotations, np.tile(skeleton.bind_translations, (frames, 1, 1)))


def swing(character: Character, *, frames: int = 20) -> Clip:
    """Begins at rest, then the upper two joints bend to and fro and the root moves sideways."""
    time = np.arange(frames) / RATE
    held = still(character, frames=frames)
    rotations, translations = held.rotations.copy(), held.translations.copy()
    rotations[:, 1] = rotation.from_axis_angle(np.array([1.0, 0, 0]), 0.6 * np.sin(4 * time))
    rotations[:, 2] = rotation.from_axis_angle(np.array([0, 0, 1.0]), 0.8 * np.sin(3 * time))
    translations[:, character.skeleton.root, 0] += 0.3 * np.sin(5 * time) ** 2
    return Clip("swing", RATE, rotations, translations)


def _wall(rings: int, sides: int) -> Mesh:
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    y = np.repeat(np.linspace(0, HEIGHT, rings), sides)
    vertices = np.stack([RADIUS * np.tile(np.sin(angle), rings), y, RADIUS * np.tile(np.cos(angle), rings)], axis=1)
    u, v = np.meshgrid(np.linspace(0.1, 0.9, sides + 1), np.linspace(0.9, 0.1, rings))
    ring, side = (index.ravel() for index in np.mgrid[: rings - 1, :sides])
    quads = _quads(ring * sides + side, ring * sides + (side + 1) % sides, sides)
    uv_quads = _quads(ring * (sides + 1) + side, ring * (sides + 1) + side + 1, sides + 1)
    return Mesh(vertices, quads, np.stack([u.ravel(), v.ravel()], axis=1), uv_quads)


def _quads(left: Array, right: Array, ring: int) -> Array:
    """Two triangles for each quad above an edge from left to right, seen from outside."""
    lower = np.stack([left, right, left + ring], axis=1)
    upper = np.stack([right, right + ring, left + ring], axis=1)
    return np.concatenate([lower, upper]).astype(np.int32)
