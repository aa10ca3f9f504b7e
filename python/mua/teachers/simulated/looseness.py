"""How loosely each part of a character hangs on its skeleton, guessed where the character does not say."""

import re

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph

from mua.arrays import Array
from mua.pose.joint_names import roles
from mua.rig.bones import figure_scale
from mua.rig.character import Character
from mua.teachers.simulated.room import room_beneath

FIRM = re.compile(r"head|neck|jaw|eye|hand|finger|thumb|index|middle|ring|pinky|little|foot|feet|toe|ankle|wrist", re.I)
LIMB = re.compile(r"arm|leg|thigh|shin|calf|spine|chest|pelvis|hip", re.I)
BODY = re.compile(LIMB.pattern + r"|shoulder|clavicle|collar|twist|roll|breast|bust|torso|abdomen|waist|body", re.I)
HOLDS = re.compile(r"hand|wrist", re.I)  # below it, joints of any name are firm: an axe, fingers
FIRM_LOOSENESS = 0.05
TIGHT_LOOSENESS = 0.2  # of skin and clothes that lie on a body: they sag by a millimetre
SOFT_LOOSENESS = 0.4  # of clothes with room beneath them, and of joints that no body has, such as those of hair
UNKNOWN_LOOSENESS = 0.3  # of everything on a skeleton whose joint names say nothing
SMALL = 0.12  # metres: a separate piece of this size or less (eye, tooth, button) is rigid
OF_LEG = 0.25  # weight of the leg's joints, from which it moves a triangle
ROOM = 0.3, 0.7  # share of lines inward that run through no body: from tight to soft
BLUR = 12  # smoothing passes over the edges, so that firm parts do not begin with a step


def estimate_looseness(character: Character) -> Array:
    """Looseness [V] from 0 (skin) to 1 (hanging cloth), by its joints and the room beneath it."""
    mesh, names = character.mesh, character.skeleton.names
    known = sum(bool(LIMB.search(name)) for name in names) >= 4 and any(FIRM.search(name) for name in names)
    if known:
        on_body = np.interp(_room(character), ROOM, (TIGHT_LOOSENESS, SOFT_LOOSENESS))
        firm, body = (_moved_by(joints, character) for joints in (_firm(character), _of_body(character)))
        looseness = firm * FIRM_LOOSENESS + body * on_body + (1 - firm - body) * SOFT_LOOSENESS
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


def _moved_by(joints: Array, character: Character) -> Array:
    """The share [V] that some of the joints [J] have in moving each vertex."""
    return np.asarray(np.sum(joints[character.skin_indices] * character.skin_weights, axis=1))


def _firm(character: Character) -> Array:
    """Whether each joint [J] is one that holds its skin firmly, or below a hand."""
    skeleton = character.skeleton
    held = np.zeros(len(skeleton.names), bool)
    for joint, parent in enumerate(skeleton.parents):
        held[joint] = parent >= 0 and (held[parent] or bool(HOLDS.search(skeleton.names[parent])))
    for role, joints in roles(skeleton, character.roles).items():
        held[list(joints)] |= bool(FIRM.search(role))
    return held | [bool(FIRM.search(name)) for name in skeleton.names]


def _room(character: Character) -> Array:
    """How much room [V] the surface has beneath it, from 0 (a body) to 1."""
    skeleton, faces = character.skeleton, character.mesh.faces
    found, legs = roles(skeleton, character.roles), np.zeros(len(faces), int)
    for side, mark in (("left", 1), ("right", 2)):
        moved = np.zeros(len(skeleton.names))
        for joint, parent in enumerate(skeleton.parents):
            moved[joint] = joint in found.get(f"{side} thigh", ()) or (parent >= 0 and moved[parent])
        legs |= mark * (_moved_by(moved, character)[faces].mean(axis=1) > OF_LEG)
    return room_beneath(character.mesh.vertices, faces, legs=legs)


def _of_body(character: Character) -> Array:
    """Whether each joint [J] that is not firm moves a body, and not something that hangs from it."""
    skeleton = character.skeleton
    body = np.array([bool(BODY.search(name)) for name in skeleton.names])
    body[[joint for joints in roles(skeleton, character.roles).values() for joint in joints]] = True
    for joint in reversed(range(len(body))):
        if body[joint] and skeleton.parents[joint] >= 0:
            body[skeleton.parents[joint]] = True
    return body & ~_firm(character)


def _in_small_pieces(vertices: Array, graph: sparse.csr_matrix) -> Array:
    """Whether each vertex [V] belongs to a separate piece of the mesh of little extent."""
    pieces, piece = csgraph.connected_components(graph, directed=False)
    low, high = np.full((pieces, 3), np.inf), np.full((pieces, 3), -np.inf)
    np.minimum.at(low, piece, vertices)
    np.maximum.at(high, piece, vertices)
    return np.asarray(((high - low).max(axis=1) < SMALL * figure_scale(vertices))[piece])
