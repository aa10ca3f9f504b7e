"""Retargeting: what limbs do in the world, checked on a T-pose person built here and on real motion."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from people import ANGLE_BOUND, POSITION_BOUND, bone_aligned, person, random_clip, retarget, still, upright, walk, world
from scipy.spatial.transform import Rotation
from shared_data import SharedData

from mua import rotation
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.amass import nominal_skeleton
from mua.motion.bvh import read_bvh
from mua.motion.match import match_joints
from mua.motion.quality import measure_motion
from mua.motion.source import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

CMU_FACING = 1e-6  # radians by which the hips of CMU's zero pose are turned from facing +Z: rounding of its offsets

ESTIMATE_BOUND = 8.0  # degrees: how far this person's trunk leans at rest, and what a walk tells of twists
LIMBS = [
    (f"{side}{bone}", f"{side}{end}")
    for side in ("Left", "Right")
    for bone, end in (("Arm", "ForeArm"), ("ForeArm", "Hand"), ("UpLeg", "Leg"), ("Leg", "Foot"))
]
CMU_NAMES = {"Arm": "humerus", "ForeArm": "radius", "Hand": "wrist", "UpLeg": "femur", "Leg": "tibia", "Foot": "foot"}
SMPL_NAMES = {"Arm": "shoulder", "ForeArm": "elbow", "Hand": "wrist", "UpLeg": "hip", "Leg": "knee", "Foot": "ankle"}


def bone(skeleton: Skeleton, clip: Clip, begin: str, end: str) -> np.ndarray:
    """Unit directions [F, 3] in the world from joint to joint."""
    at = world(skeleton, clip)[1]
    along = at[:, skeleton.names.index(end)] - at[:, skeleton.names.index(begin)]
    return np.asarray(along / np.linalg.norm(along, axis=-1, keepdims=True))


def angle(a: np.ndarray, b: np.ndarray) -> float:
    """The largest angle between unit vectors, radians."""
    return float(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)).max())


def with_offset(skeleton: Skeleton, joint: str, offset: Any) -> Skeleton:
    """The same with a joint elsewhere in its parent."""
    offsets = skeleton.bind_translations.copy()
    offsets[skeleton.names.index(joint)] = offset
    return replace(skeleton, bind_translations=offsets)


def below_a_turned_joint(skeleton: Skeleton) -> Skeleton:
    """The same skeleton in the same place under a node that is turned and moved."""
    turn, shift = Rotation.random(random_state=3).as_quat(scalar_first=True), np.array([0.3, 0.1, -0.2])
    rotations = np.concatenate([turn[None], skeleton.bind_rotations])
    rotations[1] = rotation.multiply(rotation.conjugate(turn), rotations[1])
    offsets = np.concatenate([shift[None], skeleton.bind_translations])
    offsets[1] = rotation.rotate(rotation.conjugate(turn), offsets[1] - shift)
    parents = np.concatenate([[-1], skeleton.parents + 1]).astype(np.int32)
    return Skeleton(("Armature", *skeleton.names), parents, rotations, offsets, root=1)


@pytest.mark.parametrize(
    "skeleton",
    [person(), person(axes=1), person(arms_down=50, legs_apart=15, axes=2), below_a_turned_joint(person(axes=4))],
    ids=["plain axes", "random axes", "A-pose", "below a turned joint"],
)
def test_onto_itself_is_the_identity(skeleton: Skeleton) -> None:
    clip = random_clip(skeleton)
    clip.rotations[:, : skeleton.root] = skeleton.bind_rotations[: skeleton.root]
    found, _ = retarget(SourceMotion(skeleton, clip), skeleton)
    for a, b in zip(world(skeleton, found), world(skeleton, clip), strict=True):
        sign = np.sign(np.sum(a * b, axis=-1, keepdims=True)) if a.shape[-1] == 4 else 1
        np.testing.assert_allclose(sign * a, b, atol=POSITION_BOUND)


@pytest.mark.parametrize("arms_down", [0, 50])
@pytest.mark.parametrize("legs_apart", [0, 20])
def test_limbs_point_where_the_source_points(arms_down: float, legs_apart: float) -> None:
    source, target = person(arms_down=arms_down, legs_apart=legs_apart, axes=1), person(size=1.3, axes=2)
    clip = random_clip(source)
    found, _ = retarget(SourceMotion(source, clip), target)
    for begin, end in LIMBS:
        assert angle(bone(target, found, begin, end), bone(source, clip, begin, end)) < ANGLE_BOUND


def assert_turned_as_at_rest(skeleton: Skeleton, turned: np.ndarray, *names: str) -> None:
    """`turned` [J, 4] are rotations in the world."""
    rest, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    joints = [skeleton.names.index(name) for name in names]
    np.testing.assert_allclose(np.abs(np.sum(turned[joints] * rest[joints], axis=1)), 1, atol=POSITION_BOUND)


def test_the_rest_pose_of_another_person_gives_ones_own_torso() -> None:
    source, target = person(arms_down=50, legs_apart=20, axes=1), person(axes=2)
    rest = still(source)
    turned, _ = world(target, retarget(SourceMotion(source, rest), target)[0])
    assert_turned_as_at_rest(target, turned[0], "Hips", "Spine", "Spine2", "Neck", "Head", "LeftShoulder")


def test_soles_are_level_when_splayed_legs_close() -> None:
    """Where the source's feet roll with its legs (ASF zero pose), legs straight down mean level feet."""
    source, target = person(legs_apart=20), person(axes=2)
    rotations = source.bind_rotations[None].copy()
    for side, sign in (("Left", -1), ("Right", 1)):
        turn = Rotation.from_euler("z", sign * 20, degrees=True).as_quat(scalar_first=True)
        rotations[0, source.names.index(f"{side}UpLeg")] = turn
    closed = replace(still(source), rotations=rotations)
    turned, _ = world(target, retarget(SourceMotion(source, closed), target)[0])
    assert_turned_as_at_rest(target, turned[0], "LeftFoot", "RightFoot", "LeftToeBase")


def test_soles_stay_level_where_only_the_targets_legs_are_apart() -> None:
    """A bind pose with legs apart and level soles: the feet of a source that stands level stay level."""
    source, apart = person(), person(legs_apart=20)
    _, level = source.world(source.bind_rotations, source.bind_translations)
    offsets = apart.bind_translations.copy()  # plain axes: local offsets are differences in the world
    for side in ("Left", "Right"):
        for name in (f"{side}ToeBase", f"{side}Toe_End"):
            j = apart.names.index(name)
            offsets[j] = level[j] - level[apart.parents[j]]
    target = replace(apart, bind_translations=offsets)
    rest = still(source)
    found, _ = retarget(SourceMotion(source, rest), target)
    turned, _ = world(target, found)
    np.testing.assert_allclose(np.abs(turned[0, target.names.index("LeftFoot"), 0]), 1, atol=POSITION_BOUND)
    assert angle(bone(target, found, "LeftUpLeg", "LeftLeg"), bone(source, rest, "LeftUpLeg", "LeftLeg")) < ANGLE_BOUND


@pytest.mark.parametrize("yaw", [90, 180, -37])
def test_faces_the_targets_way_whatever_way_the_source_rests(yaw: float) -> None:
    source, target = person(axes=1), person(size=1.1, axes=2)
    clip = random_clip(source)
    turn = Rotation.from_euler("y", yaw, degrees=True).as_quat(scalar_first=True)
    rest, rotations = source.bind_rotations.copy(), clip.rotations.copy()
    rest[0], rotations[:, 0] = rotation.multiply(turn, rest[0]), rotation.multiply(turn, rotations[:, 0])
    moved = with_offset(source, "Hips", rotation.rotate(turn, source.bind_translations[0]))
    turned_source = replace(moved, bind_rotations=rest)
    translations = clip.translations.copy()
    translations[:, 0] = rotation.rotate(turn, translations[:, 0])
    turned_clip = replace(clip, rotations=rotations, translations=translations)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(turned_source, turned_clip), target)
    np.testing.assert_allclose(world(target, found)[1], world(target, expected)[1], atol=POSITION_BOUND)


def test_path_and_size_scale_with_the_legs() -> None:
    small, large = person(axes=1), person(size=2, axes=1)
    clip = random_clip(small)
    found, _ = retarget(SourceMotion(small, clip), large)
    np.testing.assert_allclose(world(large, found)[1], 2 * world(small, clip)[1], atol=POSITION_BOUND)


def test_source_resting_about_its_hips_is_set_on_the_floor() -> None:
    source, target = person(), person(size=1.2, axes=2)
    floating = with_offset(source, "Hips", 0)
    standing = still(floating, 5, root=[0, 1.07, 0])
    found, _ = retarget(SourceMotion(floating, standing), target)
    expected = target.world(target.bind_rotations, target.bind_translations)[1]
    np.testing.assert_allclose(world(target, found)[1][0], expected, atol=POSITION_BOUND)


def test_keeps_the_height_of_a_clip_that_never_stands_and_says_so() -> None:
    source = person()
    floating = with_offset(source, "Hips", 0)
    flight = still(floating, 5, root=[0, 4.0, 0])
    found, notes = retarget(SourceMotion(floating, flight, notes=("The reader guessed.",)), source)
    assert world(source, found)[1][0, 0, 1] == pytest.approx(4)
    kept = "still: its feet never come nearer to the floor than 3.00 m; the height is kept."
    assert notes == ("The reader guessed.", kept)


def test_feet_that_step_on_one_level_are_put_on_the_floor() -> None:
    source = person()
    clip = walk(source)
    lifted = replace(clip, translations=clip.translations + np.eye(len(source.names))[:, :1] * [0, 0.65, 0])
    floating = with_offset(source, "Hips", 0)
    expected, _ = retarget(SourceMotion(floating, clip), source)
    found, notes = retarget(SourceMotion(floating, lifted), source)
    np.testing.assert_allclose(world(source, found)[1], world(source, expected)[1], atol=POSITION_BOUND)
    assert any("put on the floor" in note for note in notes)


def test_legs_without_feet_end_on_the_floor() -> None:
    source = person()
    clip = walk(source)
    names = tuple(name.replace("Foot", "Wheel").replace("Toe", "Cap") for name in source.names)
    target = replace(person(size=0.4), names=names)
    lifted = replace(clip, translations=clip.translations + np.eye(len(source.names))[:, :1] * [0, 0.65, 0])
    found, _ = retarget(SourceMotion(source, lifted), target)
    wheels = [names.index(f"{side}Wheel") for side in ("Left", "Right")]
    lowest = world(target, found)[1][:, wheels, 1].min(axis=1)
    assert np.abs(lowest - target.world(target.bind_rotations, target.bind_translations)[1][wheels[0], 1]).max() < 0.03


def test_feet_that_climb_keep_their_height() -> None:
    source = person()
    clip = walk(source)
    path = np.linspace(0.5, 2.0, len(clip))[:, None, None] * np.eye(len(source.names))[:, :1] * [0, 1, 0]
    climb = replace(clip, translations=clip.translations + path)
    found, _ = retarget(SourceMotion(with_offset(source, "Hips", 0), climb), source)
    assert world(source, found)[1][..., 1].min() > 0.4


def test_joints_without_a_match_keep_their_bind_rotation() -> None:
    source, target = person(axes=1), person(axes=2)
    names = tuple("Wing" if name == "LeftShoulder" else name for name in target.names)
    winged = replace(target, names=names)
    found, notes = retarget(SourceMotion(source, random_clip(source)), winged)
    j = names.index("Wing")
    np.testing.assert_array_equal(found.rotations[:, j], np.tile(target.bind_rotations[j], (9, 1)))
    assert notes[0].startswith(f"1 of {len(names)} joints")


def test_mapping_reaches_joints_that_neither_names_nor_places_give_away() -> None:
    (plain, clip), target = bone_aligned(person(), walk(person())), person(axes=2)
    names = tuple(f"Bone.{i:03}" for i in range(len(plain.names)))
    source = replace(plain, names=names)
    with pytest.raises(InputError, match="mapping file"):
        retarget(SourceMotion(source, clip), target)
    mapping = dict(zip(target.names, names, strict=True))
    found, _ = retarget(SourceMotion(source, clip), target, mapping=mapping)
    expected, _ = retarget(SourceMotion(plain, clip), target)
    np.testing.assert_array_equal(found.rotations, expected.rotations)


def median_apart(skeleton: Skeleton, clip: Clip, other: Clip) -> float:
    """How far the joint that differs most is turned otherwise in half of all frames, degrees."""
    cosines = np.abs(np.sum(world(skeleton, clip)[0] * world(skeleton, other)[0], axis=-1))
    return float(np.median(np.degrees(2 * np.arccos(np.minimum(cosines, 1))), axis=0).max())


@pytest.mark.parametrize("heading", [0, 130])
def test_bone_aligned_rest_poses_give_what_a_standing_one_gives(heading: float) -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    turn = Rotation.from_euler("y", heading, degrees=True).as_quat(scalar_first=True)
    clip.rotations[:, 0] = rotation.multiply(turn, clip.rotations[:, 0])
    clip.translations[:, 0] = rotation.rotate(turn, clip.translations[:, 0])
    straight, same = bone_aligned(source, clip)
    np.testing.assert_allclose(world(straight, same)[1], world(source, clip)[1], atol=POSITION_BOUND)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, notes = retarget(SourceMotion(straight, same), target)
    assert not any("floor" in note for note in notes)
    for begin, end in LIMBS:
        assert angle(bone(target, found, begin, end), bone(target, expected, begin, end)) < ANGLE_BOUND
    assert median_apart(target, found, expected) < ESTIMATE_BOUND
    quality = measure_motion(SourceMotion(straight, same), target, found, match_joints(straight, target))
    assert quality.flaws == ()
    assert quality.facing_degrees is not None
    assert quality.facing_degrees < ESTIMATE_BOUND


def resting_in(skeleton: Skeleton, clip: Clip, frame: int) -> Skeleton:
    """The skeleton as files without a bind pose hold it: at rest in a frame of the motion."""
    return replace(skeleton, bind_rotations=clip.rotations[frame], bind_translations=clip.translations[frame])


def test_a_rest_pose_that_is_a_frame_of_the_motion_is_not_taken_for_standing() -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(resting_in(source, clip, 10), clip), target)
    assert median_apart(target, found, expected) < ESTIMATE_BOUND


def turned_otherwise(skeleton: Skeleton, clip: Clip, joint: str, degrees: float) -> Clip:
    """The clip with all joints where they are, and one of them turned about Y besides, as a solver may leave it."""
    own = Rotation.from_euler("y", degrees, degrees=True).as_quat(scalar_first=True)
    j = skeleton.names.index(joint)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    rotations[:, j] = rotation.multiply(rotations[:, j], own)
    for child in np.flatnonzero(skeleton.parents == j):
        rotations[:, child] = rotation.multiply(rotation.conjugate(own), rotations[:, child])
        translations[:, child] = rotation.rotate(rotation.conjugate(own), translations[:, child])
    return replace(clip, rotations=rotations, translations=translations)


@pytest.mark.parametrize("joint", ["Hips", "Spine2"])
def test_a_trunk_that_frames_turn_otherwise_than_the_rest_pose_stands_faces_ahead(joint: str) -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    solved = turned_otherwise(source, clip, joint, 100)
    np.testing.assert_allclose(world(source, solved)[1], world(source, clip)[1], atol=POSITION_BOUND)
    expected, _ = retarget(SourceMotion(source, clip), target)
    found, _ = retarget(SourceMotion(source, solved), target)
    assert median_apart(target, found, expected) < ESTIMATE_BOUND


def test_a_figure_that_stands_still_in_a_pose_that_is_not_upright_is_taken_as_it_is() -> None:
    source, target = person(), person(size=1.1, axes=2)
    clip = walk(source)
    held = replace(clip, rotations=clip.rotations[[10] * 5], translations=clip.translations[[10] * 5])
    found, _ = retarget(SourceMotion(resting_in(source, held, 0), held), target)
    expected, _ = retarget(SourceMotion(source, held), target)
    assert angle(bone(target, found, "Hips", "Spine"), bone(target, expected, "Hips", "Spine")) < np.radians(10)


def test_hips_and_shoulders_of_a_bind_pose_whose_chest_is_turned_each_face_where_the_source_does() -> None:
    source, plain = person(), person(size=1.1)
    clip = walk(source)
    rotations = plain.bind_rotations.copy()
    turn = Rotation.from_euler("y", 30, degrees=True).as_quat(scalar_first=True)
    rotations[plain.names.index("Spine")] = rotation.multiply(turn, rotations[plain.names.index("Spine")])
    target = replace(plain, bind_rotations=rotations)
    found, _ = retarget(SourceMotion(*bone_aligned(source, clip)), target)
    for part in ("UpLeg", "Arm"):
        ends = (f"Right{part}", f"Left{part}")
        assert angle(bone(target, found, *ends), bone(source, clip, *ends)) < np.radians(2 * ESTIMATE_BOUND)


def test_rotations_are_copied_between_rigs_of_one_maker_whatever_the_rest_pose() -> None:
    source, target = person(axes=1), person(size=1.1, axes=1)
    plain = walk(person())
    straight = rotation.multiply(
        rotation.conjugate(world(person(), still(person()))[0]),
        world(person(), plain)[0],
    )
    turned = rotation.multiply(straight, source.world(source.bind_rotations, source.bind_translations)[0])
    above = turned[:, np.maximum(source.parents, 0)]
    local = np.where(source.parents[:, None] < 0, turned, rotation.multiply(rotation.conjugate(above), turned))
    clip = Clip("walk", 30.0, local, source.with_root(plain.translations[:, 0]))
    found, _ = retarget(SourceMotion(resting_in(source, clip, 10), clip), target)
    cosines = np.abs(np.sum(world(target, found)[0] * world(source, clip)[0], axis=-1))
    np.testing.assert_allclose(cosines, 1, atol=POSITION_BOUND)


@pytest.mark.parametrize("flat", [{0}, {1}, {2}, {0, 1}, {1, 2}, {0, 1, 2}])
def test_skeletons_without_some_extent_still_give_rotations(flat: set[int]) -> None:
    """Rest poses as broken exporters write them: all joints in one plane, on one line, in one point."""
    whole = person()
    offsets = whole.bind_translations.copy()
    offsets[:, sorted(flat)] = 0
    thin = replace(whole, bind_translations=offsets)
    for source, target in ((thin, person(axes=2)), (person(axes=2), thin)):
        found, _ = retarget(SourceMotion(source, random_clip(source)), target)
        np.testing.assert_allclose(np.linalg.norm(found.rotations, axis=-1), 1, atol=POSITION_BOUND)
        assert np.isfinite(found.translations).all()


def test_brings_the_clip_to_the_rate_asked_for() -> None:
    skeleton = person(axes=1)
    found, _ = retarget(SourceMotion(skeleton, random_clip(skeleton)), skeleton, rate=24.0)
    assert (len(found), found.rate) == (7, 24.0)


@pytest.mark.parametrize("joints", [24, 52, 55])
def test_amass_rest_pose_stands_upright_in_the_targets_place(joints: int) -> None:
    smpl, target = nominal_skeleton(joints), person(axes=2)
    standing = still(smpl, root=[0, 0.95, 0])
    found, _ = retarget(SourceMotion(smpl, standing), target)
    for begin, end in LIMBS:
        side = "left" if begin.startswith("Left") else "right"
        limb = [f"{side}_{SMPL_NAMES[part.removeprefix('Left').removeprefix('Right')]}" for part in (begin, end)]
        assert angle(bone(target, found, begin, end), bone(smpl, standing, *limb)) < ANGLE_BOUND
    turned, at = world(target, found)
    _, bind_at = target.world(target.bind_rotations, target.bind_translations)
    joints = [target.names.index(name) for name in ("Hips", "Head", "LeftFoot", "RightToeBase")]
    assert np.abs(at[0, joints, 1] - bind_at[joints, 1]).max() < 0.02
    assert_turned_as_at_rest(target, turned[0], "Hips", "Head")


@pytest.fixture(scope="module")
def woman(shared_data: SharedData) -> Skeleton:
    return read_surfaces(shared_data.path("characters/White_F_3_Casual.glb")).skeleton


@pytest.mark.parametrize("name", ["02_01", "02_03", "01_05"])
@pytest.mark.parametrize("target_name", ["person", "woman"])
def test_real_motion_moves_limbs_alike(
    shared_data: SharedData, request: pytest.FixtureRequest, name: str, target_name: str
) -> None:
    target = person(axes=3) if target_name == "person" else request.getfixturevalue("woman")
    source = read_bvh(shared_data.path(f"motion/cmu/{name}.bvh"))
    found, notes = retarget(source, target)
    assert len(found) == len(source.clip)
    assert not any("floor" in note for note in notes)
    for begin, end in LIMBS:
        limb = [
            f"{part[0].lower()}{CMU_NAMES[part.removeprefix('Left').removeprefix('Right')]}" for part in (begin, end)
        ]
        assert angle(bone(target, found, begin, end), bone(source.skeleton, source.clip, *limb)) < CMU_FACING


@pytest.mark.parametrize("name", ["02_01", "02_03"])
def test_walks_and_runs_upright_on_the_floor_with_knees_forward(
    shared_data: SharedData, woman: Skeleton, name: str
) -> None:
    clip, _ = retarget(read_bvh(shared_data.path(f"motion/cmu/{name}.bvh")), woman)
    _, at = world(woman, clip)
    place = {joint: at[:, j] for j, joint in enumerate(woman.names)}
    rest = woman.world(woman.bind_rotations, woman.bind_translations)[1]
    assert (place["Head"][:, 1] - place["Hips"][:, 1] > 0.5).all()
    assert (place["LeftHand"][:, 1] < place["Head"][:, 1]).all()
    toes = [woman.names.index(f"{side}ToeBase") for side in ("Left", "Right")]
    assert np.abs((at[:, toes, 1] - rest[toes, 1]).min(axis=0)).max() < 0.03
    forward = np.cross(place["LeftUpLeg"] - place["RightUpLeg"], [0, 1, 0])
    for side in ("Left", "Right"):
        hip, knee, ankle = (place[f"{side}{part}"] for part in ("UpLeg", "Leg", "Foot"))
        bend = np.sum((knee - (hip + ankle) / 2) * forward, axis=-1)
        assert bend.mean() > 0
        assert (bend > -0.02 * np.linalg.norm(forward, axis=-1)).all()
    travel = place["Hips"][-1] - place["Hips"][0]
    assert np.sum(travel * forward.mean(axis=0)) > 0.9 * np.linalg.norm(travel) * np.linalg.norm(forward.mean(axis=0))


def animal(*, ahead: int, size: float, knee: float) -> Skeleton:
    """An animal that stands on four legs, its head along +Z (ahead 2) or +X (0); hind knees bend by metres."""
    rows = [
        *(("Hips", "", (0, 0.5, -0.3)), ("Spine", "Hips", (0, 0.5, -0.1)), ("Chest", "Spine", (0, 0.52, 0.2))),
        *(("Neck", "Chest", (0, 0.55, 0.3)), ("Head", "Neck", (0, 0.7, 0.45))),
        *(("LeftUpperArm", "Chest", (0.1, 0.45, 0.2)), ("LeftForeArm", "LeftUpperArm", (0.1, 0.25, 0.18))),
        *(("LeftHand", "LeftForeArm", (0.1, 0.05, 0.2)), ("LeftUpLeg", "Hips", (0.1, 0.45, -0.3))),
        *(("LeftLeg", "LeftUpLeg", (0.1, 0.25, -0.3 + knee)), ("LeftFoot", "LeftLeg", (0.1, 0.05, -0.3))),
    ]
    rows += [
        (name.replace("Left", "Right"), parent.replace("Left", "Right"), (-x, y, z))
        for name, parent, (x, y, z) in rows
        if name.startswith("Left")
    ]
    names = [name for name, _, _ in rows]
    at = {name: np.array(place if ahead == 2 else (place[2], place[1], -place[0])) for name, _, place in rows}
    offsets = [size * (at[name] - (at[parent] if parent else 0)) for name, parent, _ in rows]
    return upright(names, [names.index(parent) if parent else -1 for _, parent, _ in rows], offsets)


def test_an_animal_stands_as_the_animal_of_the_motion_stands() -> None:
    source, target = animal(ahead=0, size=3, knee=0.03), animal(ahead=2, size=1, knee=0.08)
    clip, _ = retarget(SourceMotion(source, still(source, 10)), target)
    _, at = world(target, clip)
    _, rest = target.world(target.bind_rotations, target.bind_translations)
    trunk = [target.names.index(name) for name in ("Hips", "Spine", "Chest", "Neck", "Head", "LeftUpperArm")]
    np.testing.assert_allclose(at[:, trunk] - at[:, :1], np.tile(rest[trunk] - rest[0], (10, 1, 1)), atol=1e-9)
    feet = [target.names.index(f"{side}{end}") for side in ("Left", "Right") for end in ("Hand", "Foot")]
    assert abs(at[:, feet, 1] - rest[feet, 1]).max() < 0.05
