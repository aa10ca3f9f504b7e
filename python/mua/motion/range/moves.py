"""The moves of a person, pose by pose: walking, reaching, kicking, bending, and moves on the floor."""

from collections.abc import Sequence
from dataclasses import replace

from mua.motion.range.angles import Angles, both, left, mirrored, right
from mua.motion.range.played import Key

QUICK, BRISK, CALM, SLOW = 0.13, 0.2, 0.3, 0.5  # seconds in which a pose is reached


def key(seconds: float, *limbs: Angles, **trunk: float) -> Key:
    together: Angles = dict(trunk)
    for limb in limbs:
        together |= limb
    return Key(seconds, together)


def other_side(keys: Sequence[Key]) -> tuple[Key, ...]:
    """The keys with left and right exchanged."""
    return tuple(replace(one, angles=mirrored(one.angles)) for one in keys)


def with_turn(keys: Sequence[Key], turn: float) -> tuple[Key, ...]:
    """The keys with a turn of the body to the left, `turn` degrees in all."""
    steps = [turn * (place + 1) / len(keys) for place in range(len(keys))]
    return tuple(replace(one, angles=one.angles | {"turn": step}) for one, step in zip(keys, steps, strict=True))


STAND = (  # at ease: a breath and a small look to either side; it ends as it begins, so that it can be repeated
    key(CALM),
    key(1.5, both(shrug=2.5, lift=15, elbow=14), bend=-3, nod=1, look=4),
    key(1.9, left(elbow=13) | right(elbow=15), bend=1, look=-4, twist=-1.5),
    key(0.6),
)
STEP = (
    key(
        CALM,
        left(thigh=27, knee=5, foot=4, toe=10) | right(thigh=-16, knee=16, foot=-14, toe=30),
        left(plane=-80, lift=24, elbow=10) | right(plane=85, lift=24, elbow=28),
        bend=3,
        twist=8,
        look=-5,
    ),
    key(CALM, left(thigh=6, knee=10) | right(thigh=16, knee=62, foot=-4), bend=3, ear=3),
)
WALK = (*STEP, *other_side(STEP))
RUN_STEP = (
    key(
        QUICK,
        left(thigh=55, knee=50) | right(thigh=-20, knee=40, foot=-40, toe=20),
        left(plane=-85, lift=50, elbow=95) | right(plane=80, lift=40, elbow=100),
        lean=8,
        twist=14,
        hop=0.06,
    ),
    key(
        QUICK,
        left(thigh=18, knee=24, foot=8) | right(thigh=8, knee=110, foot=-20),
        left(plane=-60, lift=15, elbow=85) | right(plane=60, lift=15, elbow=85),
        lean=8,
    ),
)
SIDESTEP = (
    key(BRISK, left(out=28, knee=12) | right(out=6, knee=8), both(lift=35, elbow=30), tilt=4),
    key(BRISK, left(out=2, knee=14) | right(out=-4, knee=20, foot=-10), tilt=-3),
    key(CALM, left(out=-18, thigh=14, knee=14) | right(out=2, thigh=-8), both(lift=28), look=40),
)
WALKS = (
    key(CALM),
    *WALK,
    *with_turn(WALK, 100),
    *tuple(reversed(WALK)),
    *SIDESTEP,
    *other_side(SIDESTEP),
    *RUN_STEP,
    *other_side(RUN_STEP),
    *RUN_STEP,
)

_ARMS = (
    key(BRISK, right(lift=95, plane=88, elbow=3, pronate=60, wrist=-50), left(lift=88, plane=0, elbow=4, pronate=-70)),
    key(
        BRISK,
        right(lift=88, plane=128, elbow=55, push=18, curl=80),
        left(lift=48, plane=-85, elbow=90, arm_roll=65, wrist=55, push=-18),
        twist=38,
        look=50,
    ),
    key(
        QUICK,
        right(lift=100, plane=70, elbow=4, curl=88, push=20),
        left(lift=45, plane=50, elbow=130, curl=88),
        twist=40,
    ),
    key(
        BRISK,
        right(lift=172, plane=60, elbow=8, shrug=28, spread=14, curl=-8),
        left(lift=35, plane=-35, elbow=100, arm_roll=55),
        side=-24,
        ear=-20,
    ),
    key(
        CALM,
        right(lift=125, plane=15, elbow=138, arm_roll=-40),
        left(lift=70, plane=80, elbow=120, arm_roll=50),
        nod=-25,
    ),
    key(
        QUICK,
        right(lift=110, plane=-10, elbow=85, arm_roll=-75, wrist=-60),
        left(lift=60, plane=20, elbow=60, arm_roll=60, wrist_side=30),
        bend=-15,
    ),
    key(
        BRISK,
        right(lift=60, plane=115, elbow=20, pronate=70),
        left(lift=150, plane=80, elbow=50, wrist=60),
        bend=20,
        twist=-30,
    ),
)
REACHES = (
    key(CALM),
    key(CALM, both(lift=174, plane=30, elbow=4, shrug=28), bend=-12, nod=-30),
    *_ARMS,
    key(BRISK, both(lift=88, plane=0, elbow=3, pronate=75, spread=14, curl=-8)),
    key(QUICK, both(lift=90, plane=118, elbow=35, push=18, curl=60, wrist=30), bend=18, nod=20),
    key(BRISK, both(lift=50, plane=-88, elbow=6, push=-20, wrist=-55), bend=-20),
    *other_side(_ARMS),
    key(CALM, both(lift=40, plane=-15, elbow=110, arm_roll=45, wrist=40), twist=20),
    key(BRISK, both(lift=30, plane=75, elbow=125, pronate=-80, wrist=65, shrug=30), nod=40),
    key(BRISK, both(lift=25, plane=60, elbow=15, shrug=-5, wrist_side=-18), nod=-45),
)

_LEGS = (
    key(
        BRISK, left(thigh=75, knee=110, foot=-20) | right(knee=12), both(lift=40, plane=60, elbow=110, curl=85), lean=-5
    ),
    key(
        QUICK,
        left(thigh=118, knee=6, foot=10) | right(knee=8),
        both(lift=45, plane=10, elbow=70, curl=85),
        lean=-16,
        bend=15,
    ),
    key(BRISK, left(thigh=45, knee=85, out=30) | right(knee=10), both(lift=50, plane=50, elbow=100), tilt=12),
    key(
        QUICK,
        left(out=45, thigh=20, knee=5, foot=15) | right(out=18),
        left(lift=60, elbow=40) | right(lift=60, plane=80, elbow=110),
        tilt=34,
        side=-18,
    ),
    key(
        BRISK, left(thigh=-20, knee=95, foot=-45) | right(thigh=10, knee=15), both(lift=60, plane=40, elbow=30), lean=20
    ),
    key(
        QUICK,
        left(thigh=-20, knee=8, foot=-30) | right(thigh=62, knee=20),
        both(lift=80, plane=70, elbow=15),
        lean=58,
        bend=-20,
        nod=-40,
    ),
    key(
        BRISK,
        left(thigh=95, knee=95, thigh_roll=-35, out=25),
        left(lift=70, plane=30) | right(lift=110, plane=80, elbow=90),
    ),
    key(BRISK, left(thigh=80, knee=70, thigh_roll=33, out=-15), both(lift=50, plane=20, elbow=80), twist=-25),
    key(
        CALM,
        left(thigh=88, knee=88, foot=6) | right(thigh=-18, knee=28, foot=-10, toe=45),
        both(lift=30, plane=-15, elbow=95, arm_roll=30),
        lean=4,
    ),
    key(
        CALM,
        left(thigh=60, out=38, knee=95, foot=15) | right(out=38, knee=4, foot_roll=12),
        both(lift=85, plane=85, elbow=10),
        lean=28,
    ),
)
LEGS = (
    key(CALM),
    *_LEGS,
    key(CALM, both(thigh=112, knee=128, foot=18, out=16), both(lift=88, plane=88, elbow=6), lean=32, bend=12, nod=-15),
    key(QUICK, both(thigh=-5, knee=3, foot=-40, toe=10), both(lift=165, plane=75, elbow=10), hop=0.28),
    key(BRISK, both(thigh=65, knee=80, foot=15), both(lift=50, plane=-60), lean=28),
    *other_side(_LEGS),
    key(CALM, both(thigh=88, knee=92), both(lift=30, plane=60, elbow=60), lean=6, bend=8),
)

_SIDES = (
    key(BRISK, both(lift=60, plane=80, elbow=30), twist=44, look=72, turn=25),
    key(BRISK, left(lift=150, plane=10, elbow=30) | right(lift=18), side=34, ear=38),
    key(QUICK, left(lift=80, plane=-20) | right(lift=70, plane=110, elbow=30), twist=-40, look=-60, side=15, nod=20),
    key(BRISK, right(thigh=30, knee=30), left(lift=100, plane=100), bend=45, side=20, twist=25, look=-35, nod=-30),
)
TRUNK = (
    key(CALM),
    key(CALM, both(thigh=35, knee=6, lift=30, plane=80), lean=30, bend=40, nod=30),
    key(CALM, both(thigh=78, knee=14), both(lift=100, plane=86, elbow=6, curl=10), lean=72, bend=62, nod=25),
    key(BRISK, both(knee=12, thigh=-10), both(lift=120, plane=20, elbow=20), bend=-28, nod=-52, lean=-12),
    *_SIDES,
    key(BRISK, both(lift=25, shrug=25), look=74, nod=30),
    key(BRISK, look=-70, nod=-40, ear=-20),
    *other_side(_SIDES),
    key(BRISK, nod=44),
    key(BRISK, look=-74, nod=30, ear=15),
    key(BRISK, nod=-52),
)

_LIE = (
    key(SLOW, both(thigh=92, knee=10), both(lift=40, plane=-60, elbow=10, wrist=-50), lean=-12, bend=10),  # legs ahead
    key(CALM, both(thigh=85, out=40, thigh_roll=-38, knee=130), both(lift=35, plane=60, elbow=60), lean=-4, bend=20),
    key(SLOW, both(lift=40, plane=0), lean=-88, nod=5),
    key(BRISK, left(thigh=110, knee=120) | right(thigh=15), left(lift=165, plane=40) | right(lift=88), lean=-88),
    key(CALM, left(thigh=70, knee=80) | right(thigh=20, knee=30), both(lift=80, plane=88, elbow=60), lean=-88, roll=85),
    key(CALM, both(lift=90, plane=20, elbow=100), lean=-88, roll=178, nod=-30),
)
FLOOR = (
    key(CALM),
    key(CALM, both(thigh=85, knee=135, foot=-40), both(lift=30, plane=60, elbow=50), lean=-4),  # kneeling on the heels
    key(CALM, both(thigh=88, knee=88, foot=-40, toe=20), both(lift=88, plane=88, elbow=3, wrist=-60), lean=84, nod=-40),
    key(
        BRISK,
        left(thigh=118, knee=100) | right(thigh=45, knee=45),
        left(lift=60, plane=80) | right(lift=140, plane=80),
        lean=84,
        nod=-40,
    ),
    key(CALM, both(thigh=4, foot=15, toe=50), both(lift=80, plane=80, elbow=5, wrist=-60), lean=72, nod=-30),
    key(BRISK, both(foot=15, toe=50), both(lift=45, plane=40, elbow=110, wrist=-60), lean=82, nod=-30),
    key(SLOW),
    *_LIE,
    key(SLOW),
    key(CALM, left(out=35) | right(out=20), both(lift=165, plane=10, elbow=3), tilt=20),  # a cartwheel
    key(BRISK, both(out=42), both(lift=170, plane=5, elbow=3, wrist=-50, shrug=25), tilt=100),
    key(BRISK, both(out=44), both(lift=172, plane=5, elbow=3, wrist=-60, shrug=28), tilt=185),
    key(BRISK, both(out=42), both(lift=165, plane=5, elbow=3, shrug=20), tilt=265),
    key(BRISK, both(out=18, knee=15), both(lift=120), tilt=350),
    key(CALM, tilt=360),
    key(
        CALM, left(thigh=60, knee=10) | right(thigh=-10, knee=10), both(lift=170, plane=85, elbow=3), lean=60, tilt=360
    ),
    key(
        CALM, both(foot=-45), both(lift=172, plane=85, elbow=3, wrist=-60, shrug=28), lean=178, tilt=360
    ),  # a handstand
    key(
        CALM,
        left(thigh=60, knee=20) | right(thigh=-15, knee=40),
        both(lift=170, plane=85, elbow=6),
        lean=186,
        tilt=360,
        bend=-20,
    ),
)

MOVES = {"walk": WALKS, "reach": REACHES, "legs": LEGS, "bend and turn": TRUNK, "floor": FLOOR}
