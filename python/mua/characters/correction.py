"""A scene brought to a plausible height in metres and to facing +Z, where it does not say so itself."""

import re
from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.characters.figure_size import LEAST, MOST
from mua.characters.upright import upright_rotation
from mua.scene import Scene

HEIGHTS = (0.2, 4.0)  # metres: what a person, a child or a large animal measures
ODD_HEIGHTS = (0.1, 8.0)  # metres: beyond these a file's unit is taken to be another than it says
UNITS = (0.01, 0.001, 100.0)  # centimetres or millimetres taken for metres, metres taken for centimetres
ADULT = 1.75  # metres: what a figure is made whose file says nothing that is possible
FLAT = 1e-3  # of the length: what is lower than this has no height to judge
LYING = 0.2  # of its length: what a creature that creeps counts as high
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
FACING = 0.5  # cosine between a character's front and +Z below which it is turned


@dataclass(frozen=True)
class Correction:
    """The changes, with a sentence for each."""

    unit: float  # metres as which one metre of the file is taken
    size_notes: tuple[str, ...]
    notes: tuple[str, ...]  # all other changes


def corrected(
    scene: Scene,
    bind: Bind,
    *,
    points: Array,  # [N, 3] what the scene shows in the bind pose, at least one
    stand: bool,  # whether a person who lies is made to stand
) -> tuple[Scene, Correction]:
    """The scene at a plausible height in metres, upright and facing +Z."""
    correction = np.eye(4)
    notes = []
    upright = upright_rotation(scene, bind) if stand else None
    if upright is not None:
        correction[:3, :3] = upright
        points, bind = points @ upright.T, replace(bind, places=bind.places @ upright.T)
        notes.append(
            "The character lies in its bind pose, because the file states a wrong up axis; it is turned upright."
        )
    unit, size_notes = plausible_unit(_height(points))
    correction[:3, :3] *= unit
    turn = _quarter_turn(scene, bind)
    if turn:
        c, s = np.cos(turn * np.pi / 2).round(), np.sin(turn * np.pi / 2).round()
        correction[:3, :3] = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ correction[:3, :3]
        notes.append(
            f"The character's left and right joints show that it does not face +Z; it is turned by {turn * 90}°."
        )
    change = Correction(unit, size_notes, tuple(notes))
    if (correction == np.eye(4)).all():
        return scene, change
    return carried(scene, correction), change


def _height(points: Array) -> float:
    """How tall [N, 3] points are; of what lies flat, how long."""
    extents = np.ptp(points, axis=0)
    return float(max(extents[1], LYING * extents.max()) if extents[1] > FLAT * extents.max() else extents.max())


def carried(
    scene: Scene,
    matrix: Array,  # [4, 4]
) -> Scene:
    """The scene as a whole moved, turned or scaled."""
    moved = tuple(replace(motion, worlds=matrix @ motion.worlds) for motion in scene.motions)
    return replace(scene, rest=matrix @ scene.rest, motions=moved)


def plausible_unit(
    height: float,  # in the file's units
) -> tuple[float, tuple[str, ...]]:
    """Metres as which one unit is taken, and a sentence where that is not 1 or leaves an unusual height."""
    if ODD_HEIGHTS[0] <= height <= ODD_HEIGHTS[1]:
        return 1.0, ()
    for unit in UNITS:
        if HEIGHTS[0] <= height * unit <= HEIGHTS[1]:
            return unit, (
                f"The character is {height:.3g} units high; one unit is taken as {unit:g} m, not as 1 m, "
                f"which makes it {height * unit:.2f} m.",
            )
    if LEAST <= height <= MOST:
        return 1.0, (f"The character is {height:.3g} m high, which is unusual; its size is kept.",)
    unit = ADULT / height if height > 0 else 1.0
    return unit, (
        f"The character is {height:.3g} m high in its file, like no person or creature; it is scaled to {ADULT} m.",
    )


def _quarter_turn(scene: Scene, bind: Bind) -> int:
    """Quarter turns about +Y that make the character face +Z, by the sides that its joints have.

    What the file itself says of them goes before their names.
    """
    across = _across_by_roles(scene, bind)
    if not across.any():
        across = _across_by_names(scene, bind)
    front = np.array([-across[2], across[0]])  # x and z of left cross up
    length = np.linalg.norm(front)
    if length < 1e-6 or front[1] / length >= FACING:
        return 0
    return int(np.round(-np.arctan2(front[0], front[1]) / (np.pi / 2))) % 4


def _across_by_roles(scene: Scene, bind: Bind) -> Array:
    """The summed way [3] from right joints to left ones, by the roles that the file gives them."""
    places: dict[str, Array] = {}
    for place, node in zip(bind.places, bind.nodes, strict=True):
        if int(node) in scene.roles:
            places.setdefault(scene.roles[int(node)], place)
    across = np.zeros(3)
    for role, place in places.items():
        side, _, part = role.partition(" ")
        if side == "left" and f"right {part}" in places:
            across += place - places[f"right {part}"]
    return across


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
