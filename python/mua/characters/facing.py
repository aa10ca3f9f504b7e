"""Where a character faces in its file, and the turn that makes it face +Z."""

import re
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.pose.joint_names import SIDES as SIDE_NAMES
from mua.pose.joint_names import Roles, roles
from mua.pose.sides import SWAPPED, Figure, evidence, exchanged
from mua.pose.skeleton import Skeleton
from mua.scene import Scene

Direction: TypeAlias = Literal["+x", "-x", "+z", "-z"]
AZIMUTHS: dict[str, float] = {"+z": 0.0, "+x": 90.0, "-z": 180.0, "-x": -90.0}  # degrees from +Z towards +X
SIDES = (  # patterns of left in names, and what replaces them for right
    ("left", "right"),
    ("Left", "Right"),
    ("LEFT", "RIGHT"),
    ("(?<![A-Za-z])l(?![A-Za-z])", "r"),
    ("(?<![A-Za-z])L(?![A-Za-z])", "R"),
    ("(?<=[a-z])L(?![a-z])", "R"),  # UpperArmL
    ("(?<![A-Za-z])L(?=[A-Z][a-z])", "R"),  # LUpperArm
    ("(?<![A-Za-z])l(?=[A-Z][a-z])", "r"),  # lUpperArm
)
NEAR = 0.5  # cosine between a character's front and +Z below which it is turned
MIRRORED = "A negative scale of {} mirrors the figure: its right side is shown on the left, as the file has it."
TURNED = "The character does not face +Z in its file; it is turned by {}°. --facing says otherwise."


@dataclass(frozen=True)
class Facing:
    """What a user says about where a character faces."""

    towards: Direction | None = None  # in the file, Y up; None: by what the character shows
    turn: float = 0.0  # degrees from there, from +Z towards +X


AS_SHOWN = Facing()


def faced(scene: Scene, bind: Bind, facing: Facing, *, surface: Array | None) -> tuple[Scene, float, tuple[str, ...]]:
    """The scene with true sides, the degrees about +Y that make it face +Z, and sentences on both.

    `surface` [J, 3] is the middle of what each joint carries; None where the file holds motion alone.
    """
    found = roles_in(scene, bind)
    across, certain = _across(scene, bind, found)
    degrees, swapped = 0.0, False
    if facing.towards is not None:
        degrees = -AZIMUTHS[facing.towards]
    elif across.any():
        swapped = not certain and evidence(_figure(scene, bind, found, surface), across) < 0
        seen = across if surface is not None else _across_at_first(scene, bind, found, across)
        degrees = _quarter_turn(-across if swapped else across)
        if degrees != _quarter_turn(-seen if swapped else seen):
            degrees = 0.0  # motion whose rest pose is a moment of another
    notes = () if facing.towards or not degrees else (TURNED.format(f"{degrees % 360:.0f}"),)
    degrees += facing.turn
    if facing != AS_SHOWN:  # the user says where the front is, and so which side is left
        swapped = bool(_turned(across, degrees) @ [1, 0, 0] < -NEAR * np.linalg.norm(across))
    if swapped:
        sides = exchanged(found)
        stated = {int(bind.nodes[joint]): role for role, joints in sides.items() for joint in joints}
        scene, notes = replace(scene, roles=stated), (*notes, SWAPPED.format("character"))
    return scene, degrees, notes


def mirroring(scene: Scene, bind: Bind) -> tuple[str, ...]:
    """A sentence where a negative scale mirrors most of what the joints carry."""
    mirrored = np.linalg.det(scene.rest[:, :3, :3]) < 0
    if 2 * bind.mass[mirrored[bind.nodes]].sum() <= bind.mass.sum():
        return ()
    first = next(node for node in range(len(mirrored)) if mirrored[node])  # parents come before their children
    return (MIRRORED.format(scene.node_names[first]),)


def roles_in(scene: Scene, bind: Bind) -> Roles:
    """Roles of the joints of a bind pose: what the file states, then by names."""
    names = tuple(scene.node_names[node] for node in bind.nodes)
    still = np.tile([1.0, 0, 0, 0], (len(names), 1))
    stated = {name: scene.roles[int(node)] for name, node in zip(names, bind.nodes, strict=True) if node in scene.roles}
    return roles(Skeleton(names, bind.parents, still, bind.places, root=0), stated)


def _figure(scene: Scene, bind: Bind, found: Roles, surface: Array | None) -> Figure:
    names = [scene.node_names[node] for node in bind.nodes]
    clips = [motion.worlds[:, bind.nodes][..., :3, 3] for motion in scene.motions]
    return Figure(names, found, bind.places, clips, surface)


def _across(scene: Scene, bind: Bind, found: Roles) -> tuple[Array, bool]:
    """The summed way [3] from right joints to left ones, and whether the file itself says which are which."""
    stated = {scene.roles[int(node)] for node in bind.nodes if int(node) in scene.roles}
    across = np.zeros(3)
    for role in stated:
        side, _, part = role.partition(" ")
        if side == SIDE_NAMES[0] and f"right {part}" in stated:
            across += bind.places[found[role][0]] - bind.places[found[f"right {part}"][0]]
    return (across, True) if across.any() else (_across_by_names(scene, bind), False)


def _across_at_first(scene: Scene, bind: Bind, found: Roles, at_rest: Array) -> Array:
    """The way [3] from right joints to left ones summed over the clips' first frames; at rest where there is none."""
    firsts = [
        replace(bind, places=motion.worlds[0, bind.nodes, :3, 3]) for motion in scene.motions if len(motion.worlds)
    ]
    return sum((_across(scene, first, found)[0] for first in firsts), np.zeros(3)) if firsts else at_rest


def _across_by_names(scene: Scene, bind: Bind) -> Array:
    """The summed way [3] from right joints to left ones, by the joints' names."""
    names = [re.sub(r"_\d+$", "", scene.node_names[node]) for node in bind.nodes]  # some tools number them
    index = {name: j for j, name in enumerate(names)}
    across = np.zeros(3)
    for name, j in index.items():
        for left, right in SIDES:
            other = index.get(re.sub(left, right, name))
            if other is not None and other != j:
                across += bind.places[j] - bind.places[other]
    return across


def _quarter_turn(across: Array) -> float:
    """Degrees about +Y, a multiple of 90, that make a character face +Z, by its way from right to left [3]."""
    front = np.array([-across[2], across[0]])  # x and z of left cross up
    length = np.linalg.norm(front)
    if length < 1e-6 or front[1] / length >= NEAR:
        return 0.0
    return float(90 * (int(np.round(-np.arctan2(front[0], front[1]) / (np.pi / 2))) % 4))


def turn_about_y(degrees: float) -> Array:
    """The rotation matrix [3, 3] about +Y, exact for quarter turns."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    if degrees % 90 == 0:
        c, s = c.round(), s.round()
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def _turned(v: Array, degrees: float) -> Array:
    return np.asarray(turn_about_y(degrees) @ v)
