"""How loosely each part of a character hangs on its skeleton, guessed where the character does not say."""

import re

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from mua.arrays import Array
from mua.pose.skeleton import Skeleton
from mua.rig.bones import figure_scale
from mua.rig.character import Character

FIRM = re.compile(r"head|neck|jaw|eye|hand|finger|thumb|index|middle|ring|pinky|little|foot|feet|toe|ankle|wrist", re.I)
LIMB = re.compile(r"arm|leg|thigh|shin|calf|spine|chest|pelvis|hip", re.I)
HOLDS = re.compile(r"hand|wrist", re.I)  # below it, joints of any name are firm: an axe, fingers
FIRM_LOOSENESS = 0.05
SOFT_LOOSENESS = 0.4  # of clothes and soft tissue on a person
UNKNOWN_LOOSENESS = 0.3  # of everything on a skeleton whose joint names say nothing
SMALL = 0.12  # metres: a separate piece of this size or less (eye, tooth, button) is rigid
BLUR = 12  # smoothing passes over the edges, so that firm parts do not begin with a step


def estimate_looseness(character: Character) -> Array:
    """Looseness [V] from 0 (skin) to 1 (hanging cloth), by the names of the joints that move each vertex."""
    mesh, names = character.mesh, character.skeleton.names
    known = sum(bool(LIMB.search(name)) for name in names) >= 4 and any(FIRM.search(name) for name in names)
    if known:
        of_joint = np.where(_firm(character.skeleton), FIRM_LOOSENESS, SOFT_LOOSENESS)
        looseness = np.sum(of_joint[character.skin_indices] * character.skin_weights, axis=1)
    else:
        looseness = np.full(len(mesh.vertices), UNKNOWN_LOOSENESS)
    edges = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    count = len(mesh.vertices)
    graph = sparse.csr_matrix((np.ones(len(edges)), edges.T), shape=(count, count))
    graph = graph + graph.T
    degree = np.maximum(np.asarray(graph.sum(axis=1)).ravel(), 1)
    for _ in range(BLUR):
        looseness = (looseness + graph @ looseness / degree) / 2
    return np.where(_in_small_pieces(mesh.vertices, graph), 0.0, looseness)


def _firm(skeleton: Skeleton) -> Array:
    """Whether each joint [J] is one that holds its skin firmly, or below a hand."""
    held = np.zeros(len(skeleton.names), bool)
    for joint, parent in enumerate(skeleton.parents):
        held[joint] = parent >= 0 and (held[parent] or bool(HOLDS.search(skeleton.names[parent])))
    return held | [bool(FIRM.search(name)) for name in skeleton.names]


def _in_small_pieces(vertices: Array, graph: sparse.csr_matrix) -> Array:
    """Whether each vertex [V] belongs to a separate piece of the mesh of little extent."""
    pieces, piece = csgraph.connected_components(graph, directed=False)
    low, high = np.full((pieces, 3), np.inf), np.full((pieces, 3), -np.inf)
    np.minimum.at(low, piece, vertices)
    np.maximum.at(high, piece, vertices)
    return np.asarray(((high - low).max(axis=1) < SMALL * figure_scale(vertices))[piece])
