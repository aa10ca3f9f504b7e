"""How loosely each part of a character hangs on its skeleton, guessed where the character does not say."""

import re

import numpy as np
from scipy import sparse

from mua.arrays import Array
from mua.pose.joint_names import SIDES, roles
from mua.rig.character import Character
from mua.teachers.simulated.pieces import in_rigid_pieces
from mua.teachers.simulated.room import room_beneath

FIRM = re.compile(r"head|neck|jaw|eye|hand|finger|thumb|index|middle|ring|pinky|little|foot|feet|toe|ankle|wrist", re.I)
LIMB = re.compile(r"arm|leg|thigh|shin|calf|spine|chest|pelvis|hip", re.I)
BODY = re.compile(LIMB.pattern + r"|shoulder|clavicle|collar|twist|roll|breast|bust|torso|abdomen|waist|body", re.I)
HOLDS = re.compile(r"hand|wrist", re.I)  # below it, joints of any name are firm: an axe, fingers
FIRM_LOOSENESS = 0.05
TIGHT_LOOSENESS = 0.2  # of skin and clothes that lie on a body: they sag by a millimetre
SOFT_LOOSENESS = 0.4  # of clothes with room beneath them, and of joints that no body has, such as those of hair
UNKNOWN_LOOSENESS = 0.3  # of everything on a skeleton whose joint names say nothing
HELD = 0.5  # weight of joints below a hand, from which the hand holds a triangle
OF_LEG = 0.25  # weight of the leg's joints, from which it moves a triangle
ROOM = 0.3, 0.7  # share of lines inward that run through no body: from tight to soft
BLUR = 12  # smoothing passes over the edges, so that firm parts do not begin with a step


def estimate_looseness(character: Character) -> Array:
    """Looseness [V] from 0 (skin) to 1 (hanging cloth), by its joints and the room beneath it."""
    mesh, names = character.mesh, character.skeleton.names
    known = sum(bool(LIMB.search(name)) for name in names) >= 4 and any(FIRM.search(name) for name in names)
    of_body = _of_body(character) & known
    if known:
        on_body = np.interp(_room(character), ROOM, (TIGHT_LOOSENESS, SOFT_LOOSENESS))
        firm, body = (_moved_by(joints, character) for joints in (_firm(character), of_body))
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
    return np.where(in_rigid_pieces(character, graph, body=of_body), 0.0, looseness)


def _moved_by(joints: Array, character: Character) -> Array:
    """The share [V] that some of the joints [J] have in moving each vertex."""
    return np.asarray(np.sum(joints[character.skin_indices] * character.skin_weights, axis=1))


def _below_hands(character: Character) -> Array:
    """Whether each joint [J] is below a hand: fingers, and what the hand holds."""
    skeleton, found = character.skeleton, roles(character.skeleton, character.roles)
    hands = {joint for side in SIDES for joint in found.get(f"{side} hand", ())}
    held = np.zeros(len(skeleton.names), bool)
    for joint, parent in enumerate(skeleton.parents):
        held[joint] = parent >= 0 and (held[parent] or parent in hands or bool(HOLDS.search(skeleton.names[parent])))
    return held


def _firm(character: Character) -> Array:
    """Whether each joint [J] is one that holds its skin firmly, or below a hand."""
    firm = _below_hands(character) | [bool(FIRM.search(name)) for name in character.skeleton.names]
    for role, joints in roles(character.skeleton, character.roles).items():
        firm[list(joints)] |= bool(FIRM.search(role))
    return firm


def _room(character: Character) -> Array:
    """How much room [V] the surface has beneath it, from 0 (a body) to 1; none where a hand holds it.

    Grips reach into arms, and several weapons may share a hand: no line sees them.
    """
    skeleton, faces = character.skeleton, character.mesh.faces
    held = _moved_by(_below_hands(character), character)[faces].min(axis=1) > HELD
    faces = faces if held.all() else faces[~held]
    found, legs = roles(skeleton, character.roles), np.zeros(len(faces), int)
    for side, mark in zip(SIDES, (1, 2), strict=True):
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
