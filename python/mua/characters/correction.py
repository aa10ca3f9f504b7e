"""A scene brought to a plausible height in metres and to facing +Z, where it does not say so itself."""

from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.characters.facing import AS_SHOWN, Facing, faced, mirroring, turn_about_y
from mua.characters.figure_size import LEAST, MOST
from mua.characters.upright import upright_rotation
from mua.scene import Scene

HEIGHTS = (0.2, 4.0)  # metres: what a person, a child or a large animal measures
ODD_HEIGHTS = (0.1, 8.0)  # metres: beyond these a file's unit is taken to be another than it says
UNITS = (0.01, 0.001, 100.0)  # centimetres or millimetres taken for metres, metres taken for centimetres
ADULT = 1.75  # metres: what a figure is made whose file says nothing that is possible
FLAT = 1e-3  # of the length: what is lower than this has no height to judge
FAR = 1000.0  # metres from the origin: single precision holds places there to 0.1 mm
LYING = 0.2  # of its length: what a creature that creeps counts as high


@dataclass(frozen=True)
class Correction:
    """The changes, with a sentence for each."""

    unit: float  # metres as which one metre of the file is taken
    size_notes: tuple[str, ...]
    notes: tuple[str, ...]  # all other changes
    moved: bool  # whether anything is elsewhere than in the file


def corrected(
    scene: Scene,
    bind: Bind,
    *,
    points: Array,  # [N, 3] what the scene shows in the bind pose, at least one
    stand: bool,  # whether a person who lies is made to stand
    facing: Facing = AS_SHOWN,
    surface: Array | None = None,  # [J, 3] the middle of what each joint carries, NaN where it carries nothing
) -> tuple[Scene, Correction]:
    """The scene at a plausible height in metres, upright and facing +Z, with the sides that the body shows."""
    correction = np.eye(4)
    notes = []
    upright = upright_rotation(scene, bind) if stand else None
    if upright is not None:
        correction[:3, :3] = upright
        points, bind = points @ upright.T, replace(bind, places=bind.places @ upright.T)
        surface = None if surface is None else surface @ upright.T
        notes.append(
            "The character lies or is upside down in its bind pose, because the file states a wrong up axis; "
            "it is turned upright."
        )
    unit, size_notes = plausible_unit(_height(points))
    correction[:3, :3] *= unit
    scene, degrees, facing_notes = faced(scene, bind, facing, surface=surface)
    correction[:3, :3] = turn_about_y(degrees) @ correction[:3, :3]
    notes += [*mirroring(scene, bind), *facing_notes]
    away = _away(scene, bind, points) * unit
    if np.linalg.norm(away) > FAR:
        correction[:3, 3] = -turn_about_y(degrees) @ away
        notes.append(
            f"The character stands {np.linalg.norm(away) / 1000:.3g} km from the origin of its file; it is moved there."
        )
    change = Correction(unit, size_notes, tuple(notes), moved=bool((correction != np.eye(4)).any()))
    if not change.moved:
        return scene, change
    return carried(scene, correction), change


def _away(scene: Scene, bind: Bind, points: Array) -> Array:
    """Where [3] on the floor a figure stands; the origin where it rests, or a clip begins, far from its bind pose."""
    place = bind.places[0]
    root = bind.nodes[0]
    others = [scene.rest[root, :3, 3], *(motion.worlds[0, root, :3, 3] for motion in scene.motions)]
    apart = [np.linalg.norm(np.linalg.norm(other) - np.linalg.norm(place)) for other in others]
    near = max(apart) < np.linalg.norm(place) / 2
    return np.array([place[0], points[:, 1].min(), place[2]]) if near else np.zeros(3)


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
