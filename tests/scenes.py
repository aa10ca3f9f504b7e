"""Scenes built by hand, and what their own matrices make of them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from gltf_files import posed
from scipy.spatial.transform import Rotation

from mua.atlas.surfaces import Surfaces
from mua.scene import Material, Motion, Part, Scene, Skin

HERE = Path("body.glb")
GREY = Material("grey", np.full((1, 1, 4), 128, np.uint8))
# Double precision, coordinates about 2, chains of a dozen 4x4 products.
DOUBLE_BOUND = 2 * 12 * 4 * 2**-52
# Weights are float32, which a vertex of about 2 metres feels in full.
WEIGHT_BOUND = 2 * 8 * 2**-24


def at(x: float, y: float, z: float, turn: Rotation | None = None, scale: float = 1.0) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = (Rotation.identity() if turn is None else turn).as_matrix() * scale
    matrix[:3, 3] = x, y, z
    return matrix


NAMES = ("hips", "spine", "head", "arm_l", "arm_r")
PARENTS = np.array([-1, 0, 1, 1, 1])
BIND = np.stack([at(0, 0.9, 0), at(0, 1.2, 0), at(0, 1.6, 0), at(0.2, 1.4, 0), at(-0.2, 1.4, 0)])


def part(*, group: int = 0, skin: int = 0, seed: int = 0, count: int = 30) -> Part:
    """A soup of triangles over the whole body, each vertex on two joints."""
    generator = np.random.default_rng(seed)
    positions = generator.uniform([-0.4, 0, -0.1], [0.4, 1.8, 0.1], (count, 3))
    joints = np.stack([np.arange(count) % 5, (np.arange(count) + 1) % 5], axis=1)
    weights = np.stack([np.full(count, 0.75), np.full(count, 0.25)], axis=1)
    faces = np.arange(count).reshape(-1, 3)
    uv = generator.uniform(-1, 2, (count, 2))
    return Part(f"part{group}", group, positions, faces, uv, faces, 0, skin, joints, weights)


def scene(**changes: object) -> Scene:
    skin = Skin(np.arange(5), np.linalg.inv(BIND))
    whole = Scene("body", NAMES, PARENTS, BIND, (skin,), (part(),), (GREY,), (), ())
    return replace(whole, **changes)


def moving(rest: np.ndarray, parents: np.ndarray, *, hips: bool = True, frames: int = 9) -> Motion:
    """Every joint turns about its own axis; the hips also travel."""
    generator = np.random.default_rng(7)
    axes = generator.normal(size=(len(rest), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    worlds = np.zeros((frames, *rest.shape))
    for f in range(frames):
        for j, parent in enumerate(parents):
            local = rest[j] if parent < 0 else np.linalg.inv(rest[parent]) @ rest[j]
            turn = at(0, 0, 0, Rotation.from_rotvec(0.1 * f * axes[j]))
            shift = at(0.1 * f if hips and parent < 0 else 0, 0, 0)
            worlds[f, j] = (np.eye(4) if parent < 0 else worlds[f, parent]) @ shift @ local @ turn
    return Motion("dance", 30.0, worlds)


def skinned(whole: Scene, frame: int) -> np.ndarray:
    """Corners [F, 3, 3] by the source's own matrices: the definition of linear blend skinning."""
    corners = []
    for piece in whole.parts:
        skin = whole.skins[piece.skin]
        matrices = whole.motions[0].worlds[frame, skin.joints] @ skin.inverse_binds
        points = np.concatenate([piece.positions, np.ones((len(piece.positions), 1))], axis=1)
        moved = np.einsum("nk,nkij,nj->ni", piece.weights, matrices[piece.joints], points)[:, :3]
        corners.append(moved[piece.faces])
    return np.concatenate(corners)


def assert_follows(whole: Scene, surfaces: Surfaces, bound: float = WEIGHT_BOUND) -> None:
    (clip,) = surfaces.clips
    for frame in (0, 4, 8):
        ours = posed(surfaces, clip.rotations[frame], clip.translations[frame])[surfaces.faces]
        np.testing.assert_allclose(ours, skinned(whole, frame), atol=bound)


def in_units(unit: float) -> Scene:
    """The scene as a file of so many units a metre holds it, with a clip."""
    bind = BIND.copy()
    bind[:, :3, 3] *= unit
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    worlds[..., :3, 3] *= unit
    return scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        parts=(replace(part(), positions=part().positions * unit),),
        motions=(replace(motion, worlds=worlds),),
    )


def placed(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
