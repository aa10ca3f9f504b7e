"""Which separate pieces of a character are rigid: plates of armour and packs, and no capes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from tube import tube

from mua.arrays import Array
from mua.rig.character import Character
from mua.teachers.simulated.looseness import SOFT_LOOSENESS, estimate_looseness

NAMES = ("Hips", "Spine", "Chest", "LeftArm", "RightUpLeg", "Head", "Cape")
PARENTS = (-1, 0, 1, 2, 0, 2, 2)
CHEST, SPINE, CAPE = NAMES.index("Chest"), NAMES.index("Spine"), NAMES.index("Cape")


def sheet(top: float, bottom: float) -> Array:
    """Corners [16, 3] of a sheet 3 mm thick and 20 cm wide, behind the figure and between two heights."""
    y, x = (a.ravel() for a in np.meshgrid(np.linspace(top, bottom, 4), [-0.1, 0.1], indexing="ij"))
    return np.concatenate([np.stack([x, y, np.full(8, z)], axis=1) for z in (-0.2, -0.197)])


def wearing(vertices: Array, carriers: Sequence[tuple[int, Array]], *, names: Sequence[str] = NAMES) -> Character:
    """A tube and such a sheet, which joints carry with weights [16]."""
    character = tube(rings=101)
    mesh, skeleton, count = character.mesh, character.skeleton, len(character.mesh.vertices)
    heights = np.array([0.05, 0.6, 1.2, 1.3, 0.05, 1.4, 1.2])
    local = heights - np.where(np.array(PARENTS) < 0, 0, heights[np.array(PARENTS)])
    quads = np.array([[k, k + 1, k + 3, k + 2] for k in (0, 2, 4)])
    side = np.concatenate([quads[:, [0, 2, 1]], quads[:, [0, 3, 2]]])
    faces = np.concatenate([mesh.faces, side + count, side[:, ::-1] + count + 8])
    indices, weights = np.zeros((16, 8), np.int32), np.zeros((16, 8), np.float32)
    for slot, (joint, share) in enumerate(carriers):
        indices[:, slot], weights[:, slot] = joint, share
    return replace(
        character,
        skeleton=replace(
            skeleton,
            names=tuple(names),
            parents=np.array(PARENTS, np.int32),
            bind_rotations=np.tile([1.0, 0, 0, 0], (len(PARENTS), 1)),
            bind_translations=np.stack([0 * local, local, 0 * local], axis=1),
        ),
        mesh=replace(
            mesh,
            vertices=np.concatenate([mesh.vertices, vertices]),
            faces=faces,
            uv_faces=mesh.uv_faces[np.arange(len(faces)) % len(mesh.uv_faces)],
        ),
        skin_indices=np.concatenate([character.skin_indices, indices]),
        skin_weights=np.concatenate([character.skin_weights, weights]),
    )


def of_sheet(character: Character) -> Array:
    return estimate_looseness(character)[-16:]


WHOLE = np.ones(16)
PLATE, PACK, CLOAK = sheet(1.35, 1.15), sheet(1.35, 0.92), sheet(1.35, 0.5)
RISING = np.linspace(0, 1, 8)[np.arange(16) % 8]


@pytest.mark.parametrize("carriers", [[(CHEST, WHOLE)], [(CHEST, 0.6 * WHOLE), (SPINE, 0.4 * WHOLE)]])
@pytest.mark.parametrize("size", [1.0, 0.01, 100.0])
def test_a_plate_that_moves_as_one_is_rigid(carriers: list[tuple[int, Array]], size: float) -> None:
    character = wearing(PLATE, carriers)
    skeleton, mesh = character.skeleton, character.mesh
    larger = replace(
        character,
        mesh=replace(mesh, vertices=size * mesh.vertices),
        skeleton=replace(skeleton, bind_translations=size * skeleton.bind_translations),
    )
    looseness = estimate_looseness(larger)
    assert np.all(looseness[-16:] == 0)
    assert np.all(looseness[:-16] > 0)


def test_a_pack_that_is_strapped_on_is_rigid() -> None:
    """It reaches farther from the bones than plates do, and less far than a cape."""
    assert np.all(of_sheet(wearing(PACK, [(CHEST, WHOLE)])) == 0)


def test_a_cape_on_one_joint_hangs() -> None:
    np.testing.assert_allclose(of_sheet(wearing(CLOAK, [(CHEST, WHOLE)])), SOFT_LOOSENESS, atol=0.01)


def test_what_bends_between_joints_or_has_one_of_its_own_hangs() -> None:
    for carriers in ([(CHEST, RISING), (SPINE, 1 - RISING)], [(CAPE, WHOLE)]):
        np.testing.assert_allclose(of_sheet(wearing(PLATE, carriers)), SOFT_LOOSENESS, atol=0.01)


def test_nothing_is_a_plate_where_joint_names_say_nothing() -> None:
    assert np.all(of_sheet(wearing(PLATE, [(CHEST, WHOLE)], names=[f"b{k}" for k in range(len(NAMES))])) > 0)
