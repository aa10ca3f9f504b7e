"""Retargeting to rigs that are built in another way: joints elsewhere in the hierarchy, beside the body, or absent."""

from dataclasses import replace

import numpy as np
from people import (
    ANGLE_BOUND,
    POSITION_BOUND,
    hung_on_the_spine,
    person,
    random_clip,
    retarget,
    upright,
    walk,
    world,
)

from mua import rotation
from mua.motion import retarget as retargeting
from mua.motion.match import match_joints
from mua.motion.source_motion import SourceMotion
from mua.pose.skeleton import Skeleton


def reparented(skeleton: Skeleton, joint: str, parent: str) -> Skeleton:
    """The skeleton with its joints where they are, one of them on another parent."""
    index, above = skeleton.names.index(joint), skeleton.names.index(parent)
    turned, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    parents, rotations = skeleton.parents.copy(), skeleton.bind_rotations.copy()
    translations = skeleton.bind_translations.copy()
    parents[index] = above
    rotations[index] = rotation.multiply(rotation.conjugate(turned[above]), turned[index])
    translations[index] = rotation.rotate(rotation.conjugate(turned[above]), at[index] - at[above])
    return replace(skeleton, parents=parents, bind_rotations=rotations, bind_translations=translations)


def on_a_root(skeleton: Skeleton, *, moved: tuple[str, ...]) -> Skeleton:
    """The skeleton below a root, with a joint in its belly that nothing moves; `moved` hang on the root."""
    names = ("Root", *skeleton.names, "Belly")
    parents = np.concatenate([[-1], skeleton.parents + 1, [0]]).astype(np.int32)
    turns = np.concatenate([[[1.0, 0, 0, 0]], skeleton.bind_rotations, [[0.5, 0.5, -0.5, 0.5]]])
    shifts = np.concatenate([np.zeros((1, 3)), skeleton.bind_translations, [[0, 1.05, 0.1]]])
    found = Skeleton(names, parents, turns, shifts, root=0)
    for joint in moved:
        found = reparented(found, joint, "Root")
    return found


def test_parts_of_the_trunk_that_hang_on_the_root_go_with_the_body() -> None:
    """Rigs of cartoons have belly, chest and pelvis beside each other: what nothing moves must not stay behind."""
    body = person(axes=3)
    source = SourceMotion(body, random_clip(body))
    apart, whole = on_a_root(body, moved=("Spine",)), reparented(on_a_root(body, moved=()), "Belly", "Hips")
    clips = [retarget(source, target)[0] for target in (apart, whole)]
    turned, at = (np.stack(parts) for parts in zip(*map(world, (apart, whole), clips), strict=True))
    np.testing.assert_allclose(at[0], at[1], atol=POSITION_BOUND)
    np.testing.assert_allclose(np.abs(np.sum(turned[0] * turned[1], axis=-1)), 1, atol=ANGLE_BOUND)


def test_a_body_whose_hips_hang_on_its_spine_goes_as_a_whole() -> None:
    """Artists' mannequins are rooted in the belly: trunk and legs must not part where the motion goes."""
    body, plain = person(), person(size=0.8)
    source, target = SourceMotion(body, walk(body)), hung_on_the_spine(plain)
    found, wanted = (world(figure, retarget(source, figure)[0])[1] for figure in (target, plain))
    np.testing.assert_allclose(
        found, wanted[:, [plain.names.index(name) for name in target.names]], atol=POSITION_BOUND
    )


def test_says_which_limbs_of_the_character_nothing_moves() -> None:
    whole = person()
    arm = ("Shoulder", "Arm", "ForeArm", "Hand", "HandMiddle1")
    kept = [j for j, name in enumerate(whole.names) if name.removeprefix("Left").removeprefix("Right") not in arm]
    armless = Skeleton(
        tuple(whole.names[j] for j in kept),
        np.array([kept.index(p) if (p := int(whole.parents[j])) >= 0 else -1 for j in kept], np.int32),
        whole.bind_rotations[kept],
        whole.bind_translations[kept],
        root=kept.index(whole.root),
    )
    _, notes = retargeting.retarget(
        SourceMotion(armless, random_clip(armless)), whole, match_joints(armless, whole), rate=30.0
    )
    assert "The motion does not move left arm and right arm." in notes
    _, notes = retargeting.retarget(
        SourceMotion(whole, random_clip(whole)), armless, match_joints(whole, armless), rate=30.0
    )
    assert not [note for note in notes if "moves" in note]


def test_feet_that_hang_on_controls_stay_at_the_shins_end() -> None:
    """Rigs for inverse kinematics: feet and legs below the root, hips beside them."""
    source, plain = person(), person(size=0.8)
    names = ("Root", *plain.names)
    _, at = plain.world(plain.bind_rotations, plain.bind_translations)
    at = np.concatenate([np.zeros((1, 3)), at])
    loose = ("Hips", "LeftUpLeg", "RightUpLeg", "LeftFoot", "RightFoot")
    parents = np.concatenate([[-1], plain.parents + 1]).astype(np.int32)
    parents[[names.index(name) for name in loose]] = 0
    offsets = at - np.where(parents[:, None] < 0, 0, at[parents])
    target = upright(names, parents, offsets, root=1)
    found, _ = retarget(SourceMotion(source, walk(source)), target)
    expected, _ = retarget(SourceMotion(source, walk(source)), plain)
    np.testing.assert_allclose(world(target, found)[1][:, 1:], world(plain, expected)[1], atol=POSITION_BOUND)


def test_forearms_that_end_in_fingers_point_as_those_of_the_motion() -> None:
    """Arms without a hand, bent in the bind pose: the first finger shows where the forearm points."""
    source, target = person(), person()
    fingers = {
        f"{side}Hand{part}": f"{side}HandMiddle{i}"
        for side in ("Left", "Right")
        for i, part in ((1, ""), (2, "Middle1"))
    }
    bent = target.bind_translations.copy()
    for side, out in (("Left", 1), ("Right", -1)):
        bent[target.names.index(f"{side}Hand")] = (out * 0.18, 0, 0.18)
    target = replace(target, names=tuple(fingers.get(name, name) for name in target.names), bind_translations=bent)
    clip = random_clip(source)
    found, _ = retarget(SourceMotion(source, clip), target)
    elbow, wrist = (source.names.index(name) for name in ("LeftForeArm", "LeftHand"))
    (moved, wanted) = (at[:, wrist] - at[:, elbow] for at in (world(target, found)[1], world(source, clip)[1]))
    moved, wanted = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (moved, wanted))
    np.testing.assert_allclose(moved, wanted, atol=ANGLE_BOUND)
