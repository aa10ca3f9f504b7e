"""Poses of another figure in C#: what the package retargets, on both sides, as they come."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, RUNTIME, CSharp, by_name
from named_figures import written_names
from people import hung_on_the_spine, moving, on_thick_soles, person, random_clip, upright, walk, with_fingers
from retargeted import SECONDS, expected
from shared_data import SharedData

from mua import rotation
from mua.arrays import Array
from mua.characters.read import read_animation, read_surfaces
from mua.motion.read import read_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton

# Some hundred operations on numbers up to 10, which a chain of joints passes on; divided by bones of at least 1 cm.
BOUND = 1e5 * np.finfo(float).eps
ROOT = np.eye(len(person().names))[:, :1]  # 1 for the root joint
NEAR = 0.05  # metres by which the lower foot of a walk leaves the floor
STEP = 0.2  # metres, at least: how far the walks go


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.build([RUNTIME / "Format", RUNTIME / "Motion", PROGRAMS / "RetargetProgram.cs"])


def written(owner: str, skeleton: Skeleton) -> list[Sequence[object]]:
    return [
        (f"{owner}.names", *skeleton.names),
        (f"{owner}.parents", *skeleton.parents.tolist()),
        (f"{owner}.rotations", *skeleton.bind_rotations.ravel().tolist()),
        (f"{owner}.translations", *skeleton.bind_translations.ravel().tolist()),
        (f"{owner}.root", skeleton.root),
    ]


def save(path: Path, *cases: Sequence[Sequence[object]]) -> Path:
    path.write_text("\n\n".join("\n".join("\t".join(map(str, line)) for line in lines) for lines in cases))
    return path


class Figure:
    """Another figure that moves, and what C# makes of it."""

    def __init__(self, csharp: CSharp, program: Path, file: Path) -> None:
        self._csharp, self._program, self._file = csharp, program, file

    def tell(
        self,
        source: Skeleton,
        target: Skeleton,
        clip: Clip,
        *more: Sequence[object],
        mapping: Mapping[str, str] | None = None,
    ) -> dict[str, list[str]]:
        turned, at = source.world(clip.rotations, clip.translations)
        lines = [*written("source", source), *written("target", target), *more]
        lines.append(("rate", clip.rate))
        lines += [("map", joint, by) for joint, by in (mapping or {}).items()]
        for name, values in (("turned", turned), ("placed", at)):
            lines += [(name, *frame.ravel().tolist()) for frame in values]
        return by_name(self._csharp.run(self._program, save(self._file, lines)))

    def poses(
        self,
        source: Skeleton,
        target: Skeleton,
        clip: Clip,
        *more: Sequence[object],
        mapping: Mapping[str, str] | None = None,
    ) -> tuple[Array, Array]:
        """Local rotations [F, T, 4] and translations [F, T, 3]."""
        found = self.tell(source, target, clip, *more, mapping=mapping)
        assert found.get("allocated") == ["0"], found
        rotations, translations = (
            np.array([np.frombuffer(bytes.fromhex(frame), "<f8") for frame in found[name]])
            for name in ("rotations", "translations")
        )
        return rotations.reshape(len(clip), -1, 4), translations.reshape(len(clip), -1, 3)


@pytest.fixture
def figure(csharp: CSharp, program: Path, tmp_path: Path) -> Figure:
    return Figure(csharp, program, tmp_path / "figure.txt")


def assert_same(found: tuple[Array, Array], wanted: tuple[Array, Array]) -> None:
    apart = 1 - np.abs(np.sum(found[0] * wanted[0], axis=-1))
    np.testing.assert_allclose(apart, 0, atol=BOUND)
    np.testing.assert_allclose(found[1], wanted[1], atol=BOUND)


def turned_about(skeleton: Skeleton, degrees: float) -> Skeleton:
    """The same figure, facing another way at rest, a metre aside."""
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), np.radians(degrees))
    rotations, translations = skeleton.bind_rotations.copy(), skeleton.bind_translations.copy()
    rotations[0] = rotation.multiply(turn, rotations[0])
    translations[0] = rotation.rotate(turn, translations[0]) + np.array([1.0, 0, 0])
    return replace(skeleton, bind_rotations=rotations, bind_translations=translations)


def about_the_hips(skeleton: Skeleton) -> Skeleton:
    """The same figure, whose hips are at the origin at rest, as in motion capture."""
    return replace(skeleton, bind_translations=skeleton.bind_translations - skeleton.bind_translations[0] * ROOT)


PAIRS = {
    "smaller, in A-pose, other axes": (person(size=1.2), person(arms_down=45, size=0.8, axes=2)),
    "larger, in T-pose, fingers": (with_fingers(person(arms_down=50)), with_fingers(person(size=1.5))),
    "at rest about the hips": (about_the_hips(person(size=1.2)), person(size=0.8, axes=4)),
    "about the hips, onto thick soles": (about_the_hips(person()), on_thick_soles(person(size=0.6))),
    "hips below the spine": (person(size=1.2), hung_on_the_spine(person(size=0.8))),
    "legs apart, facing back": (turned_about(person(legs_apart=15), 180), person(axes=3)),
}


@pytest.mark.parametrize("make", [walk, moving, random_clip], ids=["walk", "arms raised", "at random"])
@pytest.mark.parametrize("pair", PAIRS)
def test_poses_are_those_of_the_package(figure: Figure, pair: str, make: object) -> None:
    source, target = PAIRS[pair]
    clip = make(source)  # type: ignore[operator]
    assert_same(figure.poses(source, target, clip), expected(SourceMotion(source, clip), target))


@pytest.mark.parametrize("motion", ["dab", "cmu/02_01"])
@pytest.mark.parametrize("character", ["lumberjack", "woman"])
def test_real_motion_is_retargeted_as_the_package_does(figure: Figure, character: str, motion: str) -> None:
    files = {"lumberjack": "characters/lumberjack.glb", "woman": "characters/White_F_3_Casual.glb"}
    path = SharedData().path(files[character])
    target = (read_animation if character == "lumberjack" else read_surfaces)(path).skeleton
    [source] = read_motion(SharedData().path(f"motion/{motion}.bvh"))
    every = slice(None, None, max(1, len(source.clip) // 20))
    clip = source.clip
    few = Clip(clip.name, clip.rate, clip.rotations[every], clip.translations[every])
    wanted = expected(replace(source, clip=few), target)
    assert_same(figure.poses(source.skeleton, target, few), wanted)


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_a_raised_arm_is_raised_on_its_own_side(figure: Figure, side: str) -> None:
    source, target = PAIRS["smaller, in A-pose, other axes"]
    rotations, translations = figure.poses(source, target, moving(source))
    _, at = target.world(rotations, translations)
    left, right = (at[:, target.names.index(f"{each}Hand"), 1] for each in ("Left", "Right"))
    frame = 0 if side == "Left" else -1  # the left arm is up at first, the right one at the end
    assert (left - right)[frame] * (1 if side == "Left" else -1) > STEP


def test_a_figure_at_rest_poses_the_avatar_at_rest(figure: Figure) -> None:
    source, target = person(size=1.2), person(size=0.8, axes=2)
    still = Clip("rest", 30.0, source.bind_rotations[None], source.bind_translations[None])
    rotations, translations = figure.poses(source, target, still)
    assert_same((rotations, translations), (target.bind_rotations[None], target.bind_translations[None]))


def test_an_avatar_that_stays_in_place_goes_up_and_down_only(figure: Figure) -> None:
    source, target = person(size=1.2), person(size=0.8)
    clip = walk(source)
    goes, stays = (figure.poses(source, target, clip, *more)[1] for more in ((), [("in place",)]))
    moved = np.ptp(goes[:, target.root], axis=0)
    assert moved[2] > STEP
    np.testing.assert_allclose(stays[:, target.root, 1], goes[:, target.root, 1], atol=BOUND)
    hips = target.world(np.tile(target.bind_rotations, (len(clip), 1, 1)), stays)[1][:, target.root]
    assert np.ptp(hips[:, [0, 2]], axis=0).max() < moved[2] / 10


def test_the_path_is_scaled_to_the_legs(figure: Figure) -> None:
    source, target = person(size=1.2), person(size=0.8)
    clip = walk(source)
    found = figure.poses(source, target, clip)[1][:, target.root]
    gone = source.world(clip.rotations, clip.translations)[1][:, source.root]
    np.testing.assert_allclose(found[-1] - found[0], (gone[-1] - gone[0]) * 0.8 / 1.2, atol=BOUND)


def test_feet_stand_where_the_rest_pose_does_not_tell_the_floor(figure: Figure) -> None:
    """A walk that lasts longer than heights are remembered, of a figure that rests about its hips and walks high up."""
    source, target = PAIRS["at rest about the hips"]
    clip = walk(source, frames=SECONDS * 30 + 90)
    clip = replace(clip, translations=clip.translations + 3 * ROOT * np.array([0, 1.0, 0]))
    found = figure.poses(source, target, clip)
    assert_same(found, expected(SourceMotion(source, clip), target))
    feet = [target.names.index(f"{side}{part}") for side in ("Left", "Right") for part in ("Foot", "ToeBase")]
    _, rest = target.world(target.bind_rotations, target.bind_translations)
    heights = (target.world(*found)[1][:, feet, 1] - rest[feet, 1]).min(axis=1)
    assert np.abs(heights).max() < NEAR


def test_roles_that_the_rig_states_need_no_names(figure: Figure) -> None:
    """As an Animator tells them; joints that are called anything."""
    named, target = person(), person(size=0.8, axes=2)
    source = replace(named, names=tuple(f"bone {joint}" for joint in range(len(named.names))))
    clip = walk(named)
    known = {joint: role for role, joints in roles(named).items() for joint in joints}
    stated = ("stated", *(known.get(joint, "") for joint in range(len(named.names))))
    by_role = {source.names[joint]: role for joint, role in known.items()}
    wanted = expected(SourceMotion(source, clip, stated=by_role), target)
    assert_same(figure.poses(source, target, clip, stated), wanted)


def test_a_mapping_moves_a_joint_that_names_leave_out(figure: Figure) -> None:
    source = person()
    target = replace(person(size=0.8), names=tuple(name.replace("LeftHandMiddle1", "hook") for name in source.names))
    clip = random_clip(source)
    mapping = {"hook": "LeftHandMiddle1"}
    wanted = expected(SourceMotion(source, clip), target, mapping)
    assert_same(figure.poses(source, target, clip, mapping=mapping), wanted)
    unmapped = figure.poses(source, target, clip)
    assert np.abs(unmapped[0] - wanted[0])[:, target.names.index("hook")].max() > BOUND


def test_joints_that_hang_beside_the_body_go_with_it(figure: Figure) -> None:
    """Feet below the root for IK, and a prop on the root that nothing moves."""
    source, plain = person(), person(size=0.8)
    parents = plain.parents.copy()
    _, at = plain.world(plain.bind_rotations, plain.bind_translations)
    below = [plain.names.index(f"{side}Foot") for side in ("Left", "Right")]
    names = ("root", *plain.names, "prop")
    parents[below] = -1
    places = np.concatenate([[[0, 0, 0]], at, [[0.3, 1.2, 0]]])
    above = np.array([-1, *(parents + 1), 0])
    offsets = places - np.where(above[:, None] < 0, 0, places[above])
    target = upright(names, above, offsets, root=1)
    clip = random_clip(source)
    assert_same(figure.poses(source, target, clip), expected(SourceMotion(source, clip), target))


REFUSED = {
    "no body that stands": (person(arms_down=-80), person(), {}, "shows no body that stands"),
    "nothing for the legs": (
        replace(person(), names=tuple(name.replace("Leg", "Thing") for name in person().names)),
        replace(person(), names=tuple(f"mixamorig_{name}" for name in person().names)),
        {},
        "move the avatar's left leg, right leg; pair their joints",
    ),
    "a joint that the avatar has not": (person(), person(), {"Tail": "Hips"}, 'the avatar has no joint "Tail"'),
    "a joint that the rig has not": (person(), person(), {"Hips": "Tail"}, 'the rig has no joint "Tail", only Hips, '),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_fit_is_a_sentence(figure: Figure, case: str) -> None:
    source, target, mapping, sentence = REFUSED[case]
    still = Clip("rest", 30.0, source.bind_rotations[None], source.bind_translations[None])
    assert sentence in figure.tell(source, target, still, mapping=mapping)["refused"][0]


def test_joints_are_known_by_the_names_that_the_package_knows(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    skeletons = written_names()
    file = save(tmp_path / "named.txt", *(written("source", skeleton) for skeleton in skeletons))
    lines = csharp.run(program, file).splitlines()
    for skeleton, line in zip(skeletons, lines, strict=True):
        pairs = (part.split("=") for part in line.split(";"))
        told = {role: tuple(map(int, joints.split(","))) for role, joints in pairs}
        assert told == roles(skeleton), skeleton.names
