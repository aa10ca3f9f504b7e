"""Mistakes in units and conventions: each is refused or warned of with its cause; correct frames are not."""

import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from people import person, still, upright
from shared_data import SharedData

from mua import rotation
from mua.arrays import Array
from mua.channels import ATTRIBUTES, SH_C0
from mua.characters.read import read_character
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose
from mua.recording import LikelyMistake, Recording, TeacherWriter
from mua.recording.plausible import Plausible, rig_findings
from mua.recording.plausible.fit import explain, unit_of
from mua.recording.plausible.pose import Poses
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.teacher import TeacherFrame
from mua.teachers.procedural import procedural_character
from mua.teachers.simulated.teacher import SimulatedTeacher

TEXELS = 96
OFFSET, ROTATION, SCALE, OPACITY, SH = ATTRIBUTES.values()
CONSTANT = slice(SH.start, SH.start + 3)


@pytest.fixture(scope="module")
def character() -> Character:
    return procedural_character()


@pytest.fixture(scope="module")
def frames(character: Character) -> list[TeacherFrame]:
    """Frames of a walk and of a turn, so that one faces away."""
    teacher = SimulatedTeacher(character, texels=TEXELS)
    played = [played_frames(teacher, clip, (0, 30)) for clip in character.clips[:2]]
    return [frame for some in played for frame in some]


@pytest.fixture(scope="module")
def rig(character: Character) -> Rig:
    return SimulatedTeacher(character, texels=TEXELS).rig


def played_frames(teacher: SimulatedTeacher, clip: Clip, wanted: tuple[int, ...]) -> list[TeacherFrame]:
    until = clip.cut(slice(0, max(wanted) + 1))
    return [frame for frame in teacher.frames(until, wanted) if isinstance(frame, TeacherFrame)]


def turned(frame: TeacherFrame, angle: float) -> Pose:
    """The pose of a figure that faces elsewhere."""
    rotations = frame.pose.rotations.copy()
    rotations[0] = rotation.multiply(rotation.from_axis_angle(np.array([0, 1.0, 0]), angle), rotations[0])
    return Pose(rotations, frame.pose.translations)


def channels(frame: TeacherFrame, where: slice, change: Callable[[Array], Array]) -> TeacherFrame:
    """The frame with some channels of its texture changed."""
    texture = frame.texture.copy()
    texture[:, where] = change(texture[:, where])
    return replace(frame, texture=texture)


def colours(frame: TeacherFrame) -> Array:
    return np.clip(0.5 + SH_C0 * frame.texture[:, CONSTANT], 0, 1)


def as_colours(frame: TeacherFrame, times: float) -> TeacherFrame:
    return channels(channels(frame, SH, np.zeros_like), CONSTANT, lambda _: times * colours(frame))


def channel_major(sh: Array) -> Array:
    return sh.reshape(-1, 4, 3).swapaxes(1, 2).reshape(-1, 12)


def scales_first(texture: Array) -> Array:
    """Scale, rotation, opacity, offset."""
    return np.concatenate([texture[:, part] for part in (SCALE, ROTATION, OPACITY, OFFSET, SH)], axis=1)


def moved(frame: TeacherFrame, rows: Array | slice, place: tuple[float, float, float]) -> TeacherFrame:
    translations = frame.pose.translations.copy()
    translations[rows] = place
    return replace(frame, pose=Pose(frame.pose.rotations, translations))


def posed(frame: TeacherFrame, rig: Rig) -> Array:
    from mua.avatar.decode import pose_splats

    return pose_splats(rig, frame.mesh, texture=frame.texture, pose=frame.pose).mesh


def positions(frame: TeacherFrame, rig: Rig) -> TeacherFrame:
    corners = frame.mesh[rig.mesh.faces[rig.texels.triangles]]
    surface = np.einsum("nvx,nv->nx", corners, rig.texels.barycentrics)
    return channels(frame, OFFSET, lambda offset: offset + surface)


def xyzw(q: Array) -> Array:
    return np.roll(q, -1, axis=1)


MISTAKES: dict[str, tuple[Callable[[TeacherFrame, Rig], TeacherFrame], str]] = {
    "mesh in millimetres": (lambda f, _: replace(f, mesh=1000 * f.mesh), "mesh .* are these millimetres?"),
    "mesh in centimetres": (lambda f, _: replace(f, mesh=100 * f.mesh), "mesh .* are these centimetres?"),
    "mesh in inches": (lambda f, _: replace(f, mesh=39.37 * f.mesh), "mesh .* are these inches?"),
    "mesh with Z up": (lambda f, _: replace(f, mesh=f.mesh[:, [0, 2, 1]] * [1, -1, 1]), "mesh .* is Z up?"),
    "mesh in millimetres with Z up": (
        lambda f, _: replace(f, mesh=1000 * f.mesh[:, [0, 2, 1]] * [1, -1, 1]),
        "mesh .* are these millimetres? is Z up?",
    ),
    "mesh left-handed": (lambda f, _: replace(f, mesh=f.mesh * [-1, 1, 1]), "mesh .* is this left-handed?"),
    "mesh posed": (lambda f, rig: replace(f, mesh=posed(f, rig)), "mesh .* is it posed? canonical space is expected"),
    "mesh in another order": (lambda f, _: replace(f, mesh=10 * f.mesh[::-1]), "mesh .* another order of vertices?"),
    "pose xyzw": (
        lambda f, _: replace(f, pose=Pose(xyzw(f.pose.rotations), f.pose.translations)),
        "pose rotations turn .* xyzw: are they?",
    ),
    "pose in millimetres": (
        lambda f, _: replace(f, pose=Pose(f.pose.rotations, 1000 * f.pose.translations)),
        "pose translations make bones 1000 times .* are these millimetres?",
    ),
    "pose with Z up": (
        lambda f, _: replace(f, pose=Pose(f.pose.rotations, f.pose.translations[:, [0, 2, 1]] * [1, -1, 1])),
        "pose translations .* is Z up?",
    ),
    "pose left-handed": (
        lambda f, _: replace(f, pose=Pose(f.pose.rotations, f.pose.translations * [-1, 1, 1])),
        "pose translations .* is this left-handed?",
    ),
    "no translations": (lambda f, _: moved(f, slice(1, None), (0, 0, 0)), "pose translations are zero .* bind pose"),
    "900 m away": (lambda f, _: moved(f, 0 * np.arange(1), (900, 1, -30)), r".* root joint at \(900, .* millimetres?"),
    "95 m high": (lambda f, _: moved(f, 0 * np.arange(1), (1, 95, 2)), r".* root joint at \(1, 95, .* centimetres?"),
    "texture all zero": (lambda f, _: channels(f, slice(0, 23), np.zeros_like), "texture: all quaternions are zero"),
    "scales themselves": (lambda f, _: channels(f, SCALE, np.exp), "texture: .* are these the scales themselves?"),
    "scales in millimetres": (
        lambda f, _: channels(f, SCALE, lambda s: s + np.log(1000)),
        "texture: .* are these logarithms of millimetres?",
    ),
    "scales first": (
        lambda f, _: replace(f, texture=scales_first(f.texture)),
        "texture: .* do the channels begin with the scales?",
    ),
    "offsets in millimetres": (
        lambda f, _: channels(f, OFFSET, lambda o: 1000 * o),
        "texture: half of all offsets .* are these centimetres or millimetres?",
    ),
    "positions": (positions, "texture: half of all offsets .* are these positions?"),
    "splats xyzw": (lambda f, _: channels(f, ROTATION, xyzw), r"texture: \d+ % of flat splats .* xyzw: are they?"),
    "colours in bytes": (lambda f, _: as_colours(f, 255), "texture: .* are these colours from 0 to 255?"),
}


def pattern(expected: str) -> str:
    """A regular expression in which a question mark is one."""
    return expected.replace("?", r"\?")


def add(directory: Path, rig: Rig, frame: TeacherFrame, texture: Array | None = None) -> None:
    with TeacherWriter(directory, rig, rate=30) as writer:
        writer.start_clip("walk")
        writer.add(frame.pose, frame.mesh, frame.texture if texture is None else texture)


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_refused_with_its_cause(rig: Rig, frames: list[TeacherFrame], tmp_path: Path, name: str) -> None:
    change, expected = MISTAKES[name]
    with pytest.raises(InputError, match=rf"recording .*: clip 'walk', frame 0: {pattern(expected)}"):
        add(tmp_path / "r", rig, change(frames[1], rig))
    assert Recording(tmp_path / "r").count() == 0
    add(tmp_path / "r", rig, frames[1])  # and the writer goes on
    assert Recording(tmp_path / "r").count() == 1


UNSURE: dict[str, tuple[Callable[[TeacherFrame], TeacherFrame], str]] = {
    "opacities": (
        lambda f: channels(f, OPACITY, lambda o: 1 / (1 + np.exp(-o))),
        "all opacities lie between .* are these opacities?",
    ),
    "colours": (lambda f: as_colours(f, 1), "the constant SH coefficients lie between .* are these colours?"),
    "all of red first": (
        lambda f: channels(f, SH, channel_major),
        "SH coefficients of degree 1 are larger .* do all four of red come first?",
    ),
    "invisible splats": (lambda f: channels(f, SCALE, lambda s: s - 8), "are these logarithms right?"),
    "offsets in centimetres": (
        lambda f: channels(f, OFFSET, lambda o: 0.3 * o / np.median(np.linalg.norm(o, axis=1))),
        "half of all offsets are longer than 0.3 m, .* are these centimetres or millimetres?",
    ),
    "scales of small splats to base 10": (
        lambda f: channels(channels(f, SCALE, np.zeros_like), SCALE, lambda s: s + np.log10(0.007)),
        "half of all splats are longer than .* are these logarithms to base 10?",
    ),
    "scales to base 10": (lambda f: channels(f, SCALE, lambda s: s / np.log(10)), "are these logarithms to base 10?"),
}


@pytest.mark.parametrize("name", UNSURE)
def test_what_may_be_meant_is_warned_of_once_and_recorded(
    rig: Rig, frames: list[TeacherFrame], tmp_path: Path, name: str
) -> None:
    change, expected = UNSURE[name]
    frame = change(frames[0])
    with TeacherWriter(tmp_path, rig, rate=30) as writer:
        writer.start_clip("walk")
        with pytest.warns(LikelyMistake, match=f"clip 'walk', frame 0: texture: .*{pattern(expected)}") as caught:
            add_twice(writer, frame)
    assert len(caught) == 1
    assert caught[0].filename == __file__
    assert Recording(tmp_path).count() == 2


def add_twice(writer: TeacherWriter, frame: TeacherFrame) -> None:
    writer.add(frame.pose, frame.mesh, frame.texture)
    writer.add(frame.pose, frame.mesh, frame.texture)


def test_world_rotations_are_recognised(rig: Rig, frames: list[TeacherFrame], tmp_path: Path) -> None:
    pose = turned(frames[0], np.radians(170))
    world, _ = rig.skeleton.world(pose.rotations, pose.translations)
    with pytest.raises(InputError, match=r"are these rotations in the world\? local ones"):
        add(tmp_path, rig, replace(frames[0], pose=Pose(world, pose.translations)))


def test_controls_beside_the_body_go_with_it_where_it_turns_round() -> None:
    """Rigs of games have targets for knees and hands on the root, far before the body: they move, and no bone grows."""
    body = person()
    _, at = body.world(body.bind_rotations, body.bind_translations)
    names = ("Root", *body.names, *(f"IK_{name}" for name in body.names))
    offsets = np.concatenate([[[0, 0, 0]], body.bind_translations, at + np.array([0, 0, 5])])
    rig = upright(names, [-1, *(body.parents + 1), *(0 for _ in body.names)], offsets, root=1)
    round_about = rig.bind_translations.copy()
    round_about[len(body.names) + 1 :] *= [-1, 1, -1]
    assert list(Poses(rig, 1.7)(Pose(rig.bind_rotations, round_about))) == []
    grown = rig.bind_translations * np.where(np.arange(len(names)) < 2, 1, 1000)[:, None]
    assert len(list(Poses(rig, 1.7)(Pose(rig.bind_rotations, grown)))) == 1


def image_of(rig: Rig, texture: Array, *, elsewhere: float) -> Array:
    size = rig.texels.size
    image = np.full((size * size, 23), elsewhere, np.float32)
    image[rig.texels.texels] = texture
    return image.reshape(size, size, 23)


@pytest.mark.parametrize(
    ("turn", "question"),
    [
        (lambda image: image.swapaxes(0, 1), "if the texture is transposed: is it?"),
        (lambda image: image[::-1], "if the texture is upside down: is it?"),
        (lambda image: image[:, ::-1], "if the texture is mirrored: is it?"),
        (lambda image: image.swapaxes(0, 1)[:, ::-1], "if the texture is transposed and upside down: is it?"),
    ],
)
def test_a_turned_image_is_recognised_by_how_its_splats_lie(
    rig: Rig, frames: list[TeacherFrame], tmp_path: Path, turn: Callable[[Array], Array], question: str
) -> None:
    image = image_of(rig, frames[0].texture, elsewhere=0.5)
    with pytest.raises(InputError, match=pattern(question)):
        add(tmp_path, rig, frames[0], turn(image))


def test_texels_that_are_empty_in_the_teachers_map_are_counted(
    rig: Rig, frames: list[TeacherFrame], tmp_path: Path
) -> None:
    image = image_of(rig, frames[0].texture, elsewhere=0)
    with pytest.raises(InputError, match=rf"zero at \d+ of {len(frames[0].texture)} valid texels: .* transposed"):
        add(tmp_path, rig, frames[0], image.swapaxes(0, 1))


@pytest.mark.parametrize(("up", "question"), [(1, "column by column"), (-1, "column by column, from the bottom")])
def test_texels_counted_by_column_are_recognised_by_how_their_splats_lie(
    rig: Rig, frames: list[TeacherFrame], tmp_path: Path, up: int, question: str
) -> None:
    row, column = np.divmod(rig.texels.texels, rig.texels.size)
    with pytest.raises(InputError, match=f"if texels are counted {question}: are they"):
        add(tmp_path, rig, frames[0], frames[0].texture[np.lexsort((up * row, column))])


def test_splats_in_posed_space_are_recognised(rig: Rig, frames: list[TeacherFrame], tmp_path: Path) -> None:
    pose = turned(frames[0], np.radians(90))
    from mua.avatar.decode import pose_splats

    splats = pose_splats(rig, frames[0].mesh, texture=frames[0].texture, pose=pose)
    in_world = channels(frames[0], ROTATION, lambda _: splats.rotations)
    with pytest.raises(InputError, match=r"in posed space: are they posed\?"):
        add(tmp_path, rig, replace(in_world, pose=pose))


def test_numbered_frames_come_in_order_and_once(rig: Rig, frames: list[TeacherFrame], tmp_path: Path) -> None:
    pose = frames[0].pose
    with TeacherWriter(tmp_path, rig, rate=30) as writer:
        writer.start_clip("walk")
        writer.add(pose, frame=0)
        writer.add(pose, frame=1)
        for number in (0, 1):
            with pytest.raises(InputError, match=f"clip 'walk', frame 2: frame={number} was added already"):
                writer.add(pose, frame=number)
        with pytest.raises(InputError, match=r"frame=4 comes after frame 1, expected frame=2: .* pose alone"):
            writer.add(pose, frame=4)
        writer.add(pose, frame=2)
        assert writer.next_frame("walk") == 3


def test_correct_frames_pass_without_a_warning(rig: Rig, frames: list[TeacherFrame], tmp_path: Path) -> None:
    """Also quaternions of any length and sign, as networks put them out, and round splats, which lie nowhere."""
    with warnings.catch_warnings(), TeacherWriter(tmp_path, rig, rate=30) as writer:
        warnings.simplefilter("error")
        writer.start_clip("walk")
        for number, frame in enumerate(frames):
            writer.add(frame.pose, frame.mesh, frame.texture, frame=2 * number)
            image = image_of(rig, channels(frame, ROTATION, lambda q: -3 * q).texture, elsewhere=0)
            round_ones = channels(frame, SCALE, lambda s: 0 * s + s.mean()).texture
            writer.add(turned(frame, 3.0), frame.mesh, image if number % 2 else round_ones, frame=2 * number + 1)


@pytest.mark.parametrize("name", ["Fox.glb", "lumberjack.glb", "White_F_3_Casual.glb"])
def test_real_characters_and_their_clips_pass_without_a_warning(shared_data: SharedData, name: str) -> None:
    character = read_character(shared_data.path(f"characters/{name}"), uv="keep", atlas_size=128)
    teacher = SimulatedTeacher(replace(character, source=None), texels=TEXELS)
    plausible = Plausible(teacher.rig)
    found = list(rig_findings(teacher.rig))
    for clip in character.clips:
        found += [finding for index in range(len(clip)) for finding in plausible.pose(clip.pose(index))]
    clips = character.clips[:1] or [still(character.skeleton, 4)]
    for frame in (frame for clip in clips for frame in played_frames(teacher, clip, (0, 3))):
        found += plausible.frame(frame.pose, frame.mesh, frame.texture)
    assert found == []


@pytest.mark.parametrize(("ratio", "unit"), [(980, "millimetres"), (105, "centimetres"), (40, "inches"), (2, None)])
def test_a_ratio_near_a_unit_is_taken_for_it(ratio: float, unit: str | None) -> None:
    assert unit_of(ratio) == unit


def test_only_what_a_mistake_explains_well_is_explained() -> None:
    expected = np.random.default_rng(0).standard_normal((50, 3))
    assert explain(expected[::-1], expected) is None
    found = explain(0.001 * expected[:, [2, 0, 1]], expected)
    assert found is not None
    assert found.question == "are these kilometres? are the axes others? (y, z, x) fits"
