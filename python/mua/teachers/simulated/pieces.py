"""Which separate pieces of a character's mesh are rigid: small ones, such as buttons, plates of armour, and packs.

A plate or a pack moves as one with a joint of the body and lies near the bones that begin there; a cape, which often
hangs on one joint too, reaches farther.
"""

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from mua.arrays import Array
from mua.rig.bones import capsule_distance, figure_scale
from mua.rig.character import Character

SMALL = 0.12  # metres on a person: a piece of this size or less (eye, tooth, button) is rigid
REACH = 0.45  # metres on a person: how far plates and packs reach from the bones of their joint; capes go farther
ALIKE = 0.2  # root mean square difference between the skin weights of a piece, below which it moves as one


def in_rigid_pieces(
    character: Character,
    edges: sparse.csr_matrix,  # [V, V] of the mesh
    *,
    body: Array,  # [J] whether each joint moves a body, and not something that hangs from it
) -> Array:
    """Whether each vertex [V] belongs to a rigid piece."""
    vertices, piece = character.mesh.vertices, csgraph.connected_components(edges, directed=False)[1]
    extent = np.max([_largest(vertices[:, k], piece) + _largest(-vertices[:, k], piece) for k in range(3)], axis=0)
    joints, alike = _carriers(character, piece)
    reach = _largest(_from_bones(character, joints[piece]), piece)
    scale = figure_scale(vertices)
    plates = alike & body[joints] & (reach < REACH * scale)
    return np.asarray((plates | (extent < SMALL * scale))[piece])


def _largest(values: Array, piece: Array) -> Array:
    """The largest of values [V] in each piece [P]."""
    found = np.full(piece.max() + 1, -np.inf)
    np.maximum.at(found, piece, values)
    return found


def _carriers(character: Character, piece: Array) -> tuple[Array, Array]:
    """The joint [P] that moves each piece most, and whether all its vertices move alike."""
    weights, joints = character.skin_weights.astype(float), character.skin_indices
    count, size = np.bincount(piece), len(character.skeleton.names)
    places = np.repeat(piece, joints.shape[1]), joints.ravel()
    total = sparse.csr_matrix((weights.ravel(), places), shape=(len(count), size))
    squares = np.bincount(piece, np.sum(weights**2, axis=1)) / count
    variance = squares - np.asarray(total.power(2).sum(axis=1)).ravel() / count**2
    return np.asarray(total.argmax(axis=1)).ravel(), variance < ALIKE**2


def _from_bones(character: Character, joints: Array) -> Array:
    """How far [V] each vertex is from the bones that begin at a joint, one for each vertex."""
    skeleton, vertices = character.skeleton, character.mesh.vertices
    _, places = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    away = np.full(len(vertices), np.inf)
    for joint in np.unique(joints):
        own = joints == joint
        for end in (joint, *np.flatnonzero(skeleton.parents == joint)):
            away[own] = np.minimum(away[own], capsule_distance(vertices[own], places[joint], places[end]))
    return away
