"""The simulated teacher: frames that keep the contract between canonical mesh, offsets and the texels' transforms."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from tube import still, swing, tube

from mua import rotation
from mua.avatar.decode import express
from mua.baking.plan import split
from mua.channels import ATTRIBUTES, CHANNELS
from mua.kernels.dq_skinning import blend_texels, blend_vertices, skin_splats
from mua.pose.clip import RANGE_OF_MOTION, Clip, Stretches
from mua.pose.skeleton import Pose
from mua.recording import PlannedClip
from mua.recording.record import played
from mua.rig.bones import fit_bones
from mua.rig.character import Character
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig
from mua.teacher import TeacherFrame
from mua.teachers.simulated.chords import SEEN
from mua.teachers.simulated.folds import Folds
from mua.teachers.simulated.simulation import Simulation
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.simulated.teacher import SimulatedTeacher
from mua.texture import depths, ends, rims

SIZE = 48
SINGLE = 32 * float(np.finfo(np.float32).eps)  # metres; sums of some ten terms of up to 2 m


def whole_frames(teacher: SimulatedTeacher, clip: Clip) -> list[TeacherFrame]:
    return [frame for frame in teacher.frames(clip, range(len(clip))) if isinstance(frame, TeacherFrame)]


def posed(rig: Rig, frame: TeacherFrame) -> tuple[np.ndarray, np.ndarray]:
    """Centres [N, 3] and rotations [N, 4] of a frame's splats in the world."""
    joints = rig.skeleton.skinning(frame.pose.rotations, frame.pose.translations)
    vertex_dq = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
    surface = rig.mesh.faces, rig.texels.triangles, rig.texels.barycentrics
    centres, rotations, _, _ = skin_splats(blend_texels(vertex_dq, *surface), frame.mesh, *surface, frame.texture)
    return centres, rotations


@pytest.fixture(scope="module")
def teacher() -> SimulatedTeacher:
    return SimulatedTeacher(tube(looseness=0.6), texels=SIZE)


@pytest.fixture
def unsunk(monkeypatch: pytest.MonkeyPatch) -> None:
    """Splats lie on the surface and not a little below it, at their texels' points along all borders too."""
    monkeypatch.setattr(depths, "SINK", 0.0)
    monkeypatch.setattr(rims, "FARTHEST", 0.0)
    monkeypatch.setattr(ends, "LEAST", 1.0)


def test_a_teacher_takes_over_what_another_prepared(teacher: SimulatedTeacher) -> None:
    """In another process: it goes there by pickle."""
    character = tube(looseness=0.6)
    corrections = np.full((len(teacher.rig.texels.texels), 9), 0.01)
    still = StillTeacher(character, texels=SIZE).corrected(corrections)
    other = SimulatedTeacher(character, texels=SIZE, prepared=pickle.loads(pickle.dumps(still.prepared)))
    own = SimulatedTeacher(character, texels=SIZE, corrections=corrections)
    frames = [whole_frames(one, swing(character))[-1] for one in (other, own)]
    assert np.array_equal(frames[0].texture, frames[1].texture)
    assert np.array_equal(frames[0].mesh, frames[1].mesh)
    assert not np.array_equal(frames[0].texture, whole_frames(teacher, swing(character))[-1].texture)


def test_whole_frames_have_the_shapes_of_the_rig(teacher: SimulatedTeacher) -> None:
    (frame,) = whole_frames(teacher, still(tube(), frames=1))
    assert frame.mesh.shape == teacher.rig.mesh.vertices.shape
    assert frame.texture.shape == (len(teacher.rig.texels.texels), CHANNELS)
    assert frame.mesh.dtype == frame.texture.dtype == np.float32
    assert np.isfinite(frame.texture).all()


def test_frames_not_wanted_are_poses_and_change_nothing(teacher: SimulatedTeacher) -> None:
    clip = swing(tube())
    every = whole_frames(teacher, clip)
    some = list(teacher.frames(clip, {3, 11}))
    assert [i for i, frame in enumerate(some) if isinstance(frame, TeacherFrame)] == [3, 11]
    assert all(isinstance(frame, Pose) for i, frame in enumerate(some) if i not in {3, 11})
    assert isinstance(some[11], TeacherFrame)
    np.testing.assert_array_equal(some[11].texture, every[11].texture)
    np.testing.assert_array_equal(some[11].mesh, every[11].mesh)


def test_a_frame_of_the_range_of_motion_follows_from_its_pose_alone(teacher: SimulatedTeacher) -> None:
    clip = swing(tube()).cut(slice(20))
    shown = replace(clip, name=f"{RANGE_OF_MOTION}swing")
    backwards = replace(shown, rotations=shown.rotations[::-1], translations=shown.translations[::-1])
    frames, mirrored = whole_frames(teacher, shown), whole_frames(teacher, backwards)
    for one, other in zip(frames, mirrored[::-1], strict=True):
        np.testing.assert_array_equal(one.mesh, other.mesh)
        np.testing.assert_array_equal(one.texture, other.texture)
    assert np.abs(frames[-1].mesh - whole_frames(teacher, clip)[-1].mesh).max() > 1e-3
    some = list(teacher.frames(shown, {3}))
    assert [i for i, frame in enumerate(some) if isinstance(frame, TeacherFrame)] == [3]


def test_a_held_out_end_goes_on_from_the_motion_before_it(teacher: SimulatedTeacher) -> None:
    clip = swing(tube()).cut(slice(20))
    _, (end,) = split([clip], [])
    planned = PlannedClip(end.clip, held_out=True, wanted=frozenset({0, 3}), run_up=end.run_up)
    whole = [frame for frame in teacher.frames(clip, {16, 19}) if isinstance(frame, TeacherFrame)]
    after = [frame for frame in played(teacher, planned, planned.wanted) if isinstance(frame, TeacherFrame)]
    unmoved = [frame for frame in teacher.frames(end.clip, {0, 3}) if isinstance(frame, TeacherFrame)]
    assert len(whole) == 2
    for one, other, cold in zip(whole, after, unmoved, strict=True):
        np.testing.assert_array_equal(one.mesh, other.mesh)
        np.testing.assert_array_equal(one.texture, other.texture)
        assert np.abs(cold.texture - one.texture).max() > 1e-3


@pytest.mark.usefixtures("unsunk")
def test_in_the_bind_pose_splats_lie_on_the_surface() -> None:
    character = tube(looseness=0.6)
    teacher = SimulatedTeacher(character, texels=SIZE)
    frame = whole_frames(teacher, still(character))[-1]
    rig = teacher.rig
    corners = rig.mesh.vertices[rig.mesh.faces[rig.texels.triangles]]
    expected = np.einsum("nk,nkc->nc", rig.texels.barycentrics, corners)
    np.testing.assert_allclose(posed(rig, frame)[0], expected, atol=SINGLE)
    np.testing.assert_allclose(frame.mesh, rig.mesh.vertices, atol=SINGLE)


def test_splats_lie_below_the_surface_by_a_share_of_their_smaller_deviation(
    teacher: SimulatedTeacher, monkeypatch: pytest.MonkeyPatch
) -> None:
    frame = whole_frames(teacher, still(tube()))[-1]
    sunk, rotations = posed(teacher.rig, frame)
    share = depths.SINK
    monkeypatch.setattr(depths, "SINK", 0.0)
    unsunk = SimulatedTeacher(tube(looseness=0.6), texels=SIZE)
    on_surface, _ = posed(unsunk.rig, whole_frames(unsunk, still(tube()))[-1])
    smaller = np.exp(frame.texture[:, 7:9]).min(axis=1, keepdims=True)
    below = share * smaller * rotation.rotate(rotations, np.array([0.0, 0, 1]))
    np.testing.assert_allclose(on_surface - sunk, below, atol=SINGLE)


def at_vertices(looseness: float) -> tuple[Character, SimulatedTeacher, np.ndarray, np.ndarray]:
    """A tube with a texel at each vertex: which of the teacher's texels these are, and whose vertex each is."""
    character = tube(rings=SIZE // 2 + 1, sides=7, looseness=looseness)
    size = 2 * SIZE
    uv = (np.round(character.mesh.uv * size - 0.5) + 0.5) / size  # vertices in the middle of texels
    character = replace(character, mesh=replace(character.mesh, uv=uv))
    teacher = SimulatedTeacher(character, texels=size)
    rig = teacher.rig
    at_vertex = rig.texels.barycentrics.max(axis=1) > 1 - 1e-6
    corner = rig.texels.barycentrics[at_vertex].argmax(axis=1)
    vertex = rig.mesh.faces[rig.texels.triangles[at_vertex], corner]
    assert len(np.unique(vertex)) == len(rig.mesh.vertices)
    return character, teacher, at_vertex, vertex


def flaring() -> Character:
    """A tube whose upper half an expression turns from the sky."""
    character = tube(rings=9, sides=12, looseness=0.0)
    mesh = character.mesh.vertices
    height = mesh[:, 1] - np.median(mesh[:, 1])
    upper = np.flatnonzero(height > 1e-6).astype(np.int32)
    offsets = (4 * height[upper, None] * mesh[upper] * [1, 0, 1]).astype(np.float32)
    return replace(character, expressions=Expressions(("flare",), np.array([0, len(upper)], np.int32), upper, offsets))


def test_expressions_light_an_avatar_as_they_light_the_figure_in_poses_of_its_motion() -> None:
    """A figure that leans back, of which the bind pose says little."""
    character = flaring()
    rotations = character.skeleton.bind_rotations.copy()
    rotations[1] = [np.cos(0.5), -np.sin(0.5), 0, 0]
    pose = replace(character.skeleton.bind_pose, rotations=rotations)
    errors = []
    for lit_in in ((), (pose, pose)):
        teacher = SimulatedTeacher(character, texels=SIZE, lit_in=lit_in)
        rest, lit = teacher.frame(pose), teacher.frame(replace(pose, expressions=np.ones(1)))
        found = express(teacher.rig, rest.mesh, texture=rest.texture, weights=np.ones(1))[1]
        errors.append(np.abs(found[:, 11:14] - lit.texture[:, 11:14]).mean())
    assert errors[1] < errors[0] / 2


def test_expressions_light_an_avatar_as_they_light_the_figure() -> None:
    """Colours follow where the expression moves something, and none beyond."""
    character = flaring()
    teacher = SimulatedTeacher(character, texels=SIZE)
    pose = character.skeleton.bind_pose
    rest, lit = teacher.frame(pose), teacher.frame(replace(pose, expressions=np.ones(1)))
    found = express(teacher.rig, rest.mesh, texture=rest.texture, weights=np.ones(1))[1]
    rig = teacher.rig
    assert rig.expressions is not None
    corners = np.isin(rig.mesh.faces[rig.texels.triangles], rig.expressions.vertices)
    at = np.sum(corners * rig.texels.barycentrics, axis=1) > 0.99
    # What is the same from all sides; the sheen, which turns but does not fade.
    for channels, left in ((slice(11, 14), 1 / 3), (slice(14, 23), 3 / 4)):
        before, after = (
            np.abs(texture[at, channels] - lit.texture[at, channels]).mean() for texture in (rest.texture, found)
        )
        assert after < left * before
    far = ~corners.any(axis=1)
    np.testing.assert_array_equal(found[far, 11:14], rest.texture[far, 11:14])


@pytest.mark.usefixtures("unsunk")
def test_without_simulation_a_squash_is_in_the_surface_too() -> None:
    character, teacher, at_vertex, vertex = at_vertices(looseness=0.0)
    squash = np.diag([1.2, 0.7, 1.2])
    held = still(character, frames=1)
    stretches = Stretches(np.arange(3), np.tile(squash, (1, 3, 1, 1)))
    frame = StillTeacher(character, texels=2 * SIZE).frame(
        Pose(held.rotations[0], held.translations[0] @ squash), stretches
    )
    expected = character.mesh.vertices[vertex] @ squash
    np.testing.assert_allclose(posed(teacher.rig, frame)[0][at_vertex], expected, atol=SINGLE)


@pytest.mark.usefixtures("unsunk")
def test_texels_of_long_triangles_stay_on_them() -> None:
    """A tube of three rings that is bent by 100 degrees: its triangles stay flat, as in the source."""
    character = tube(rings=3, sides=7, looseness=0.0)
    teacher = SimulatedTeacher(character, texels=SIZE)
    bent = still(character, frames=2)
    rotations = bent.rotations.copy()
    rotations[1, 1] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(100))
    clip = replace(bent, rotations=rotations)
    frame = whole_frames(teacher, clip)[1]
    rig = teacher.rig
    joints = rig.skeleton.skinning(rotations[1], clip.translations[1])
    vertices = linear_blend(joints, rig.skin_indices, rig.skin_weights, rig.mesh.vertices)
    corners = vertices[rig.mesh.faces[rig.texels.triangles]]
    expected = np.einsum("nk,nkc->nc", rig.texels.barycentrics, corners)
    away = np.linalg.norm(posed(rig, frame)[0] - expected, axis=1)
    assert away.max() < 2 * SEEN * 1.75
    assert np.mean(away < 10 * SINGLE) > 0.3  # of the rest, the arcs are too low to be seen


@pytest.mark.usefixtures("unsunk")
def test_a_squash_of_the_source_is_in_the_surface() -> None:
    """The whole body 30 % flatter, as a scaled joint above all makes it: every joint scales, and stands nearer."""
    character, teacher, at_vertex, vertex = at_vertices(looseness=0.0)
    squash = np.diag([1.2, 0.7, 1.2])
    held = still(character, frames=2)
    translations = np.stack([held.translations[0], held.translations[0] @ squash])
    matrices = np.stack([np.tile(np.eye(3), (3, 1, 1)), np.tile(squash, (3, 1, 1))])
    clip = replace(held, translations=translations, stretches=Stretches(np.arange(3), matrices))
    rest, flat = whole_frames(teacher, clip)
    assert np.abs(flat.mesh - rest.mesh).max() > 0.05  # long deformation is the mesh's
    for frame, shape in ((rest, np.eye(3)), (flat, squash)):
        expected = character.mesh.vertices[vertex] @ shape
        np.testing.assert_allclose(posed(teacher.rig, frame)[0][at_vertex], expected, atol=SINGLE)
    spread = ATTRIBUTES["scale"]
    assert (flat.texture[:, spread] - rest.texture[:, spread]).max() > np.log(1.1)  # splats widen with their surface


@pytest.mark.usefixtures("unsunk")
def test_mesh_offsets_and_texel_transforms_rebuild_the_simulated_surface() -> None:
    """Splats at vertices of the template have no interpolation between them and the simulation."""
    character, teacher, at_vertex, vertex = at_vertices(looseness=0.6)
    rig, clip = teacher.rig, swing(character)
    moved = simulated_vertices(character, clip)
    assert len(moved) == len(clip)
    for frame, expected in zip(whole_frames(teacher, clip), moved, strict=True):
        np.testing.assert_allclose(posed(rig, frame)[0][at_vertex], expected[vertex], atol=SINGLE)


def test_a_rigid_tube_keeps_its_canonical_shape() -> None:
    """Every vertex hangs on one joint: nowhere do the blends of the file and of the avatar differ."""
    character = tube(looseness=0.0)
    weights = np.zeros_like(character.skin_weights)
    weights[:, 0] = 1
    character = replace(character, skin_weights=weights)
    teacher = SimulatedTeacher(character, texels=SIZE)
    rig = teacher.rig
    carried = rig.skin_indices[rig.mesh.faces[rig.texels.triangles], 0]
    alone = np.all(carried == carried[:, :1], axis=1)  # by one joint; between two, long triangles are straightened
    frames = whole_frames(teacher, swing(character))
    assert len(frames) > 1
    assert alone.any()
    for frame in frames:
        np.testing.assert_allclose(frame.mesh, teacher.rig.mesh.vertices, atol=SINGLE)
        np.testing.assert_allclose(frame.texture[alone, :3], frames[0].texture[alone, :3], atol=SINGLE)


def test_quaternions_are_unit_and_on_the_hemisphere_of_the_bind_pose(teacher: SimulatedTeacher) -> None:
    bind = whole_frames(teacher, still(tube()))[-1].texture[:, ATTRIBUTES["rotation"]]
    frames = whole_frames(teacher, swing(tube()))
    assert len(frames) > 1
    for frame in frames:
        q = frame.texture[:, ATTRIBUTES["rotation"]]
        np.testing.assert_allclose(np.linalg.norm(q, axis=1), 1, atol=SINGLE)
        assert np.min(np.sum(q * bind, axis=1)) > 0.5


def test_surfels_lie_in_the_posed_surface(teacher: SimulatedTeacher) -> None:
    """Compares their z axes with normals from differences of neighbouring splats' centres."""
    rig = teacher.rig
    flat = np.full(SIZE * SIZE, -1)
    flat[rig.texels.texels] = np.arange(len(rig.texels.texels))
    grid = flat.reshape(SIZE, SIZE)
    here, right, below = (part.ravel() for part in (grid[:-1, :-1], grid[:-1, 1:], grid[1:, :-1]))
    inside = (here >= 0) & (right >= 0) & (below >= 0)
    here, right, below = here[inside], right[inside], below[inside]
    frames = whole_frames(teacher, swing(tube()))[::5]
    assert len(frames) > 1
    for frame in frames:
        centres, rotations = posed(rig, frame)
        normals = np.cross(centres[below] - centres[here], centres[right] - centres[here])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        dots = np.sum(normals * rotation.rotate(rotations[here], np.array([0, 0, 1.0])), axis=1)
        assert np.quantile(dots, 0.02) > np.cos(1.5 * np.pi / 13)  # the tube has 13 corners


def test_appearance_does_not_depend_on_heading_or_place(teacher: SimulatedTeacher) -> None:
    character, clip = tube(), swing(tube())
    yaw = rotation.from_axis_angle(np.array([0, 1.0, 0]), 2.0)
    rotations = clip.rotations.copy()
    rotations[:, 0] = rotation.multiply(yaw, rotations[:, 0])
    origin, translations = character.skeleton.bind_translations[0], clip.translations.copy()
    translations[:, 0] = rotation.rotate(yaw, translations[:, 0] - origin) + origin + [3, 0, 1]
    turned = Clip("turned", clip.rate, rotations, translations)
    first, second = whole_frames(teacher, clip)[-1], whole_frames(teacher, turned)[-1]
    single_in_motion = 100 * SINGLE  # the simulation divides positions of up to 4 m by substeps
    np.testing.assert_allclose(second.texture, first.texture, atol=single_in_motion)
    np.testing.assert_allclose(second.mesh, first.mesh, atol=single_in_motion)


def linear_blend(joints: np.ndarray, indices: np.ndarray, weights: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Vertices [V, 3] in the world as file formats skin them."""
    carried = np.stack([rotation.dual_transform(joints[joint], vertices) for joint in indices.T])
    return np.asarray(np.einsum("vk,kvc->vc", weights, carried))


@pytest.mark.usefixtures("unsunk")
def test_splats_lie_where_the_linear_blend_of_the_file_puts_the_surface() -> None:
    """A tube that bends by 140 degrees, where the dual quaternions of the avatar alone would lead far outside."""
    character, teacher, at_vertex, vertex = at_vertices(looseness=0.0)
    bent = still(character, frames=2)
    rotations = bent.rotations.copy()
    rotations[1, 1] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(140))
    clip = replace(bent, rotations=rotations)
    frame = whole_frames(teacher, clip)[1]
    joints = character.skeleton.skinning(rotations[1], clip.translations[1])
    skin = character.skin_indices, character.skin_weights
    expected = linear_blend(joints, *skin, character.mesh.vertices)
    rounder = rotation.dual_transform(blend_vertices(joints, *skin), character.mesh.vertices)
    assert np.linalg.norm(rounder - expected, axis=1).max() > 0.02
    np.testing.assert_allclose(posed(teacher.rig, frame)[0][at_vertex], expected[vertex], atol=SINGLE)


def simulated_vertices(character: Character, clip: Clip) -> list[np.ndarray]:
    """Positions [V, 3] of the dense surface in every frame, from folds and simulation themselves, seed 0."""
    assert character.looseness is not None
    bones = fit_bones(character, character.looseness)
    mesh = character.mesh
    state = Simulation(mesh.vertices, mesh.faces, looseness=character.looseness, bones=bones)
    folds = Folds(mesh.vertices, mesh.faces, looseness=character.looseness, rng=np.random.default_rng(0))
    result = []
    for frame, joints in enumerate(character.skeleton.skinning(clip.rotations, clip.translations)):
        dual = blend_vertices(joints, character.skin_indices, character.skin_weights)
        turn, ends = dual[:, :4], bones.posed(joints)
        blended = linear_blend(joints, character.skin_indices, character.skin_weights, mesh.vertices)
        target = folds(blended, turn)
        if frame == 0:
            state.settle(target, turn, ends)
        result.append(state.advance(target, turn, ends, seconds=1 / clip.rate))
    return result


@pytest.mark.parametrize("factor", [2.0**-7, 2.0**5])  # 14 mm and 56 m high
def test_a_figure_of_any_size_moves_alike(factor: float) -> None:
    person = tube(looseness=0.6)
    skeleton = replace(person.skeleton, bind_translations=factor * person.skeleton.bind_translations)
    mesh = replace(person.mesh, vertices=factor * person.mesh.vertices)
    other, clip = replace(person, skeleton=skeleton, mesh=mesh), swing(person)
    last = len(clip) - 1
    scaled = replace(clip, translations=factor * clip.translations)
    frames = [
        list(SimulatedTeacher(figure, texels=48).frames(motion, {last}))[last]
        for figure, motion in ((person, clip), (other, scaled))
    ]
    one, two = (frame for frame in frames if isinstance(frame, TeacherFrame))
    bound = 1e-4  # float32 positions of a metre's size, 20 frames of 4 substeps and 4 iterations
    np.testing.assert_allclose(two.mesh / factor, one.mesh, atol=bound)
    np.testing.assert_allclose(two.texture[:, :3] / factor, one.texture[:, :3], atol=bound)
    np.testing.assert_allclose(two.texture[:, 7:10] - np.log(factor), one.texture[:, 7:10], atol=100 * bound)
    np.testing.assert_allclose(two.texture[:, 11:], one.texture[:, 11:], atol=100 * bound)
