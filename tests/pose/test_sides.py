"""Which side is left: what a body shows against what its joints are called."""

from collections.abc import Mapping

import numpy as np
import pytest

from mua.pose.joint_names import roles
from mua.pose.sides import CERTAIN, NAMES, Figure, evidence
from mua.pose.skeleton import Skeleton

LEFT_AS_CALLED, RIGHT_AS_CALLED = np.array([1.0, 0, 0]), np.array([-1.0, 0, 0])  # of a body that faces +Z


def figure(joints: Mapping[str, tuple[float, float, float]], carried: Mapping[str, float] | None = None) -> Figure:
    """Joints below the first one, and how far ahead of them the middle is of what they carry."""
    names, places = tuple(joints), np.array(list(joints.values()))
    still = np.tile([1.0, 0, 0, 0], (len(names), 1))
    skeleton = Skeleton(names, np.array([-1] + [0] * (len(names) - 1), np.int32), still, places, root=0)
    surface = np.full((len(names), 3), np.nan)
    for name, ahead in (carried or {}).items():
        surface[names.index(name)] = np.add(joints[name], (0, 0.1, ahead))
    return Figure(names, roles(skeleton), places, surface=surface)


SPIDER: dict[str, tuple[float, float, float]] = {
    "Thorax": (0, 0.3, 0),
    "Abdomen": (0, 0.3, -0.4),
    "Leg1": (0.4, 0, 0.1),
    "Leg2": (-0.4, 0, 0.1),
}
BLOCKS: dict[str, tuple[float, float, float]] = {"hips": (0, 0.8, 0), "neck": (0, 1.7, 0), "head": (0, 1.85, 0)} | {
    f"{part}.{side}": (x * width, height, 0)
    for part, width, height in (("upper_arm", 0.5, 1.6), ("thigh", 0.2, 0.8), ("shin", 0.2, 0.4), ("foot", 0.2, 0))
    for side, x in (("L", 1), ("R", -1))
}


def test_an_abdomen_is_behind() -> None:
    spider = figure(SPIDER)
    assert evidence(spider, LEFT_AS_CALLED) > NAMES
    assert evidence(spider, RIGHT_AS_CALLED) < 0


@pytest.mark.parametrize(("feet", "names_hold"), [(0.0, True), (0.05, False)])
def test_a_face_ahead_of_its_joint_only_adds_to_other_evidence(feet: float, names_hold: bool) -> None:
    blocks = figure(BLOCKS, {"head": 0.2, "foot.L": feet, "foot.R": feet})
    away = figure(
        {name: (-x, y, z) for name, (x, y, z) in BLOCKS.items()}, {"head": 0.2, "foot.L": feet, "foot.R": feet}
    )
    assert evidence(blocks, LEFT_AS_CALLED) > NAMES
    assert bool(evidence(away, RIGHT_AS_CALLED) > 0) is names_hold


def test_hair_behind_a_head_does_not_exchange_the_sides() -> None:
    assert 0 < evidence(figure(BLOCKS, {"head": -0.5}), LEFT_AS_CALLED) < NAMES < CERTAIN
