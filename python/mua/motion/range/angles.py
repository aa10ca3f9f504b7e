"""The angles that a person's pose is written in, in degrees, and how far each of them goes.

The limits are those of healthy adults, rounded: hip, knee, ankle, shoulder and elbow by the Joint Range of Motion Study
(https://archive.cdc.gov/www_cdc_gov/ncbddd/jointrom/index.html), the others by the appendix of joint ranges of
https://accessphysiotherapy.mhmedical.com/content.aspx?bookid=3363&sectionid=279000501. Upper arms are raised within a
plane, as the International Society of Biomechanics describes shoulders (Wu et al. 2005,
https://doi.org/10.1016/j.jbiomech.2004.05.042).
"""

from collections.abc import Sequence

import numpy as np

from mua.arrays import Array
from mua.pose.joint_names import SIDES

Angles = dict[str, float]

ROOT = ("lean", "tilt", "turn", "roll", "hop")  # forward, to the right, to the left, about its own axis; metres
TRUNK = {
    "bend": (-30, 75),  # of the spine, forward
    "side": (-35, 35),
    "twist": (-45, 45),
    "nod": (-55, 45),  # of neck and head
    "ear": (-40, 40),
    "look": (-75, 75),
}
LIMB = {
    "shrug": (-5, 30),
    "push": (-20, 20),  # of the collar bone, forward
    "lift": (0, 175),  # of the upper arm, from hanging, within the plane that `plane` turns from sideways to the front
    "plane": (-90, 130),
    "arm_roll": (-80, 70),  # inward
    "elbow": (0, 145),
    "pronate": (-80, 80),
    "wrist": (-65, 70),  # toward the palm
    "wrist_side": (-20, 35),  # toward the little finger
    "curl": (-10, 90),  # of every joint of the fingers
    "spread": (-5, 15),
    "thigh": (-20, 125),  # forward
    "out": (-25, 45),  # of the thigh, sideways
    "thigh_roll": (-40, 35),  # inward
    "knee": (0, 140),
    "foot": (-50, 20),  # toes up
    "foot_roll": (-25, 30),
    "toe": (-30, 60),  # up
}
LIMITS = TRUNK | {f"{side} {name}": limits for side in SIDES for name, limits in LIMB.items()}
NAMES = (*ROOT, *LIMITS)
INDEX = {name: place for place, name in enumerate(NAMES)}
MIRRORED = ("tilt", "turn", "roll", "side", "twist", "ear", "look")  # change their sign from left to right
NEUTRAL = {"lift": 14, "elbow": 12, "knee": 4, "curl": 18, "out": 3}  # of somebody who stands at ease


def left(**angles: float) -> Angles:
    return {f"left {name}": angle for name, angle in angles.items()}


def right(**angles: float) -> Angles:
    return {f"right {name}": angle for name, angle in angles.items()}


def both(**angles: float) -> Angles:
    return left(**angles) | right(**angles)


def mirrored(angles: Angles) -> Angles:
    """The angles with left and right exchanged."""
    swap = {"left": "right", "right": "left"}
    found = {}
    for name, angle in angles.items():
        side, _, own = name.rpartition(" ")
        found[f"{swap[side]} {own}" if side else own] = -angle if name in MIRRORED else angle
    return found


def table(poses: Sequence[Angles]) -> Array:
    """Angles [P, A] of poses, those of somebody at ease where a pose says none."""
    angles = np.zeros((len(poses), len(NAMES)))
    for row, pose in zip(angles, poses, strict=True):
        for name, angle in (both(**NEUTRAL) | pose).items():
            row[INDEX[name]] = angle
    return angles
