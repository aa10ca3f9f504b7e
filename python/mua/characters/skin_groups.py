"""Skins of a file that were bound together, seen as one: a body in several meshes is placed as a whole."""

import numpy as np

from mua.arrays import Array
from mua.scene import Scene, Skin

AGREEMENT = 1e-3  # relative difference below which two joints put the mesh at the same place


def grouped(scene: Scene) -> list[tuple[Skin, Array]]:
    """One skin for each group of skins that were bound together, with the weights of its joints; heaviest first.

    A group's inverse binds are all from the mesh space of its heaviest skin. Rigid skins belong to none.
    """
    masses = [scene.masses(s) for s in range(len(scene.skins))]
    groups: list[list[tuple[Skin, Array]]] = []
    for s in sorted(range(len(masses)), key=lambda s: -masses[s].sum()):
        skin, mass = scene.skins[s], masses[s]
        if skin.rigid or not mass.any():
            continue
        for group in groups:
            space = next((found for other in group if (found := _relation(skin, mass, *other)) is not None), None)
            if space is not None:
                group.append((Skin(skin.joints, skin.inverse_binds @ np.linalg.inv(space)), mass))
                break
        else:
            groups.append([(skin, mass)])
    return sorted((_joined(group) for group in groups), key=lambda joined: -joined[1].sum())


def _joined(group: list[tuple[Skin, Array]]) -> tuple[Skin, Array]:
    """One skin of all joints, each with the inverse bind of the skin that gives it most weight."""
    joints = np.concatenate([skin.joints for skin, _ in group])
    binds = np.concatenate([skin.inverse_binds for skin, _ in group])
    mass = np.concatenate([mass for _, mass in group])
    order = np.argsort(-mass, kind="stable")
    first = order[np.sort(np.unique(joints[order], return_index=True)[1])]
    total = np.array([mass[joints == joint].sum() for joint in joints[first]])
    return Skin(joints[first], binds[first], quantised=group[0][0].quantised), total


def _relation(skin: Skin, mass: Array, other: Skin, weights: Array) -> Array | None:
    """The matrix [4, 4] from a skin's mesh space to another's, by the joints that both list; None where they disagree.

    A joint that both use decides. Else most must agree, with one among them that either uses: joints without weights
    are often left at the identity.
    """
    _, mine, theirs = np.intersect1d(skin.joints, other.joints, return_indices=True)
    if not len(mine):
        return None
    binds = np.linalg.inv(other.inverse_binds[theirs])
    spaces = binds @ skin.inverse_binds[mine]
    shared = np.minimum(mass[mine], weights[theirs])
    if shared.any():
        return np.asarray(spaces[int(np.argmax(shared))])
    scale = np.abs(np.linalg.det(spaces[:, :3, :3])) ** (1 / 3)
    close = alike(spaces, scale, size=np.ptp(binds[:, :3, 3], axis=0).max() + 1e-9)
    best = int(np.argmax(close.sum(axis=1)))
    used = (mass[mine] + weights[theirs])[close[best]] > 0
    return np.asarray(spaces[best]) if 2 * len(used) > len(mine) and used.any() else None


def alike(spaces: Array, scale: Array, *, size: float) -> Array:
    """Which of the matrices [n, 4, 4] agree with which [n, n], by their scale [n] and the size of what they place."""
    turned = np.abs(spaces[:, None, :3, :3] - spaces[None, :, :3, :3]).max(axis=(-1, -2)) / scale[:, None]
    moved = np.abs(spaces[:, None, :3, 3] - spaces[None, :, :3, 3]).max(axis=-1) / size
    return np.asarray((turned < AGREEMENT) & (moved < AGREEMENT))
