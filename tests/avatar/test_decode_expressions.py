"""Expressions in decoding: what bends is an independent solution's, what does not stays bit for bit."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import polar
from scipy.spatial.transform import Rotation
from synthetic_avatar import synthetic_avatar, with_expressions, with_one_sided, with_rules

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.decode import Splats, express
from mua.errors import InputError
from mua.kernels.expressions import (
    LEAST,
    MOST_STRETCH,
    bend_texels,
    bend_triangles,
    bend_vertices,
    by_vertex,
    reach_of,
    stars_of,
)
from mua.pose.resample import resample
from mua.pose.skeleton import Pose
from mua.rig.expressions import Expressions
from mua.texture.sh import linear

ROUNDING = 1e-12  # of numbers about 1, in float64
SINGLE = 1e-4  # in float32: triangles whose height is a tenth of their sides, of 24-bit coordinates


def map_of(before: Array, after: Array) -> Array:
    """The map [3, 3] of a triangle's edges and unit normal to another's, by solving for it."""

    def columns(corners: Array) -> Array:
        first, second = corners[1] - corners[0], corners[2] - corners[0]
        normal = np.cross(first, second)
        return np.column_stack([first, second, normal / np.linalg.norm(normal)])

    return np.linalg.solve(columns(before).T, columns(after).T).T


def reflection(normal: Array) -> Array:
    """Half a turn [3, 3] about the normal: from where a mirror's light comes to where it goes."""
    return Rotation.from_rotvec(np.pi * normal).as_matrix()


def gradients(texel: Array) -> Array:
    """How a texel's red, green and blue [3, 3] change with the direction in which they are seen."""
    return linear(texel[None, 11:])[0]


def soup(rng: np.random.Generator, count: int) -> tuple[Array, Array, Array]:
    """Triangles with corners of their own [3 n, 3], how far these move, and the faces."""
    corners = rng.normal(size=(count, 3, 3))
    return corners.reshape(-1, 3), rng.normal(0, 0.5, (3 * count, 3)), np.arange(3 * count).reshape(-1, 3)


def bend(mesh: Array, moved: Array, faces: Array, triangles: Array, texture: Array) -> Array:
    """The middles of triangles."""
    bends = bend_vertices(bend_triangles(mesh, moved, faces), *stars_of(faces, len(mesh)))
    return bend_texels(bends, faces[triangles], np.full((len(texture), 3), 1 / 3, mesh.dtype), texture)


def assert_bends_as_solved(dtype: type, bound: float) -> None:
    rng = np.random.default_rng(0)
    mesh, moved, faces = (a if a.dtype.kind == "i" else a.astype(dtype) for a in soup(rng, 300))
    texture: Array = rng.normal(size=(300, 23)).astype(dtype)
    bent = bend(mesh, moved, faces, np.arange(300), texture)
    assert bent.dtype == dtype
    for texel, found, face in zip(texture.astype(float), bent.astype(float), faces, strict=True):
        before = mesh[face].astype(float)
        deformation = map_of(before, before + moved[face])
        turn = polar(deformation)[0]
        own = Rotation.from_quat(texel[3:7], scalar_first=True).as_matrix()
        stretch = np.linalg.norm(deformation @ own, axis=0)
        np.testing.assert_allclose(found[0:3], turn @ texel[0:3], rtol=0, atol=10 * bound)
        np.testing.assert_allclose(
            Rotation.from_quat(found[3:7], scalar_first=True).as_matrix(), turn @ own, rtol=0, atol=10 * bound
        )
        assert np.linalg.norm(found[3:7]) == pytest.approx(np.linalg.norm(texel[3:7]), rel=bound)
        expected = texel[7:10] + np.log(np.clip(stretch, 1 / MOST_STRETCH, MOST_STRETCH))
        np.testing.assert_allclose(found[7:10], expected, rtol=0, atol=10 * bound)
        np.testing.assert_array_equal(found[10:14], texel[10:14])
        mirrored = [reflection(turn @ own[:, 2]) @ reflection(own[:, 2]) @ gradient for gradient in gradients(texel)]
        np.testing.assert_allclose(gradients(found), mirrored, rtol=0, atol=10 * bound)


def test_a_texel_follows_the_polar_rotation_and_the_stretch_of_a_lone_triangle() -> None:
    assert_bends_as_solved(np.float64, 1e-10)


def test_single_precision_stays_near() -> None:
    assert_bends_as_solved(np.float32, SINGLE)


def test_a_rigid_motion_turns_a_texel_and_leaves_its_size() -> None:
    rng = np.random.default_rng(1)
    mesh, _, faces = soup(rng, 20)
    turn = Rotation.random(rng=2)
    moved = turn.apply(mesh) + np.array([1, 2, 3]) - mesh
    texture = rng.normal(size=(20, 23))
    bent = bend(mesh, moved, faces, np.arange(20), texture)
    np.testing.assert_allclose(bent[:, 0:3], turn.apply(texture[:, 0:3]), rtol=0, atol=1e-9)
    np.testing.assert_allclose(bent[:, 7:10], texture[:, 7:10], rtol=0, atol=1e-9)
    own, found = (Rotation.from_quat(t[:, 3:7], scalar_first=True) for t in (texture, bent))
    np.testing.assert_allclose((turn * own).as_matrix(), found.as_matrix(), rtol=0, atol=1e-9)


def test_a_splat_grows_with_its_triangle_up_to_a_bound_and_keeps_its_thickness() -> None:
    corners, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    texture = np.zeros((1, 23))
    texture[:, 3] = 1
    for factor, grown in ((2.0, 2.0), (0.5, 0.5), (1000.0, MOST_STRETCH), (0.001, 1 / MOST_STRETCH)):
        bent = bend(corners, (factor - 1) * corners, faces, np.zeros(1, int), texture)
        np.testing.assert_allclose(np.exp(bent[0, 7:10]), [grown, grown, 1], rtol=ROUNDING)


def fan(rng: np.random.Generator, count: int) -> tuple[Array, Array]:
    """Vertices about one in the middle, and the triangles between them."""
    around = np.linspace(0, 2 * np.pi, count, endpoint=False)
    mesh = np.vstack([[0, 0, 0], np.stack([np.cos(around), np.sin(around), 0 * around], axis=1)])
    mesh += rng.normal(0, 0.1, mesh.shape)
    ring = np.arange(count)
    return mesh, np.stack([0 * ring, 1 + ring, 1 + (ring + 1) % count], axis=1)


def test_texels_at_a_vertex_bend_as_the_triangles_about_it_on_average() -> None:
    """By the lesser of their areas; on either side of an edge texels bend alike."""
    rng, count = np.random.default_rng(6), 7
    mesh, faces = fan(rng, count)
    moved = rng.normal(0, 0.2, mesh.shape)
    texture = np.tile(rng.normal(size=(1, 23)), (count, 1))
    bends = bend_vertices(bend_triangles(mesh, moved, faces), *stars_of(faces, len(mesh)))
    middle = np.tile([1.0, 0, 0], (count, 1))
    found = bend_texels(bends, faces, middle, texture)
    np.testing.assert_allclose(found, found[[0] * count], rtol=0, atol=ROUNDING)
    turn, stretch, weight = np.zeros(4), np.zeros((3, 3)), 0.0
    for face in faces:
        before, after = mesh[face], (mesh + moved)[face]
        area = min(float(np.linalg.norm(np.cross(c[1] - c[0], c[2] - c[0]))) / 2 for c in (before, after))
        own, symmetric = polar(map_of(before, after))
        turn += area * Rotation.from_matrix(own).as_quat(canonical=True, scalar_first=True)
        stretch, weight = stretch + area * symmetric, weight + area
    rotated = Rotation.from_quat(turn, scalar_first=True)
    np.testing.assert_allclose(found[0, 0:3], rotated.apply(texture[0, 0:3]), rtol=0, atol=1e-10)
    axes = Rotation.from_quat(texture[0, 3:7], scalar_first=True).as_matrix()
    grown = np.log(np.linalg.norm(stretch / weight @ axes, axis=0))
    np.testing.assert_allclose(found[0, 7:10], texture[0, 7:10] + grown, rtol=0, atol=1e-10)


def test_quaternions_of_opposite_signs_do_not_cancel() -> None:
    """Nearly half a turn, whose quaternions with a w of 0 or more lie far apart."""
    mesh, faces = fan(np.random.default_rng(7), 12)
    whole = Rotation.from_euler("x", np.pi)
    moved = whole.apply(mesh) - mesh + np.random.default_rng(8).normal(0, 0.02, mesh.shape)
    texture = np.random.default_rng(9).normal(size=(12, 23))
    bent = bend(mesh, moved, faces, np.arange(12), texture)
    np.testing.assert_allclose(bent[:, 0:3], whole.apply(texture[:, 0:3]), rtol=0, atol=0.3)


def test_texels_of_a_triangle_that_vanishes_bend_as_their_neighbours() -> None:
    """Also where it is a line before; a square of which one half is squeezed or opened."""
    open_square = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    shut = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0.5, 0]])
    faces, turn = np.array([[0, 1, 2], [1, 3, 2]]), Rotation.from_euler("z", 40, degrees=True)
    texture = np.random.default_rng(10).normal(size=(2, 23))
    for before, after in ((open_square, shut), (shut, open_square)):
        bent = bend(before, turn.apply(after) - before, faces, np.array([0, 1]), texture)
        np.testing.assert_allclose(bent[:, 0:3], turn.apply(texture[:, 0:3]), rtol=0, atol=1e-9)
        np.testing.assert_allclose(bent[:, 7:10], texture[:, 7:10], rtol=0, atol=1e-9)


def test_texels_stay_as_they_are_where_all_triangles_vanish() -> None:
    flat, faces = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])
    texture = np.random.default_rng(3).normal(size=(1, 23))
    line, point, thin = flat * [1, 0, 0], flat * 0, flat * [1, LEAST / 2, 1]
    for before, after in [(flat, line), (flat, point), (line, flat), (point, flat), (thin, flat), (flat, thin)]:
        bent = bend(before, after - before, faces, np.zeros(1, int), texture)
        np.testing.assert_array_equal(bent, texture)


def test_lists_by_vertex_hold_every_entry_once_and_sum_to_the_same() -> None:
    rng, count = np.random.default_rng(4), 40
    moved = [np.sort(rng.permutation(count)[:n]) for n in (7, 0, 13, 1, 25)]
    changes = rng.normal(size=(sum(map(len, moved)), 4))
    starts = np.cumsum([0, *map(len, moved)])
    expressions = Expressions(tuple("abcde"), starts, np.concatenate(moved), changes[:, :3], changes[:, 3])
    targets, weights = by_vertex(starts, expressions.vertices, expressions.changes), rng.random(5)
    assert (np.diff(targets.vertices) > 0).all()
    found = np.zeros((count, 4))
    for vertex, first, end in zip(targets.vertices, targets.starts[:-1], targets.starts[1:], strict=True):
        assert (np.diff(targets.expressions[first:end]) > 0).all()
        found[vertex] = weights[targets.expressions[first:end]] @ targets.changes[first:end]
    expected = expressions.displacement(weights, vertices=count)
    np.testing.assert_allclose(found[:, :3], expected, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(found[:, 3], expressions.brightening(weights, vertices=count), rtol=0, atol=ROUNDING)


def test_nothing_is_reached_where_nothing_moves() -> None:
    targets = by_vertex(np.zeros(4, int), np.zeros(0, int), np.zeros((0, 4)))
    assert (len(targets.vertices), targets.starts.tolist()) == (0, [0])
    reach = reach_of(targets.vertices, np.array([[0, 1, 2]]), np.zeros(9, int))
    assert not reach.texels.any()
    assert (reach.corners.shape, reach.texels.shape, reach.starts.tolist()) == ((0, 3), (9,), [0])


def test_in_reach_are_triangles_that_have_a_corner_beside_what_moves() -> None:
    faces = np.array([[0, 1, 2], [5, 6, 7], [1, 2, 4], [4, 5, 6], [2, 8, 9]])
    reach = reach_of(np.array([0]), faces, np.array([3, 2, 0, 1, 2, 3]))
    assert reach.vertices.tolist() == [0, 1, 2, 4, 8, 9]
    assert reach.corners.tolist() == [[0, 1, 2], [1, 2, 4], [2, 8, 9]]
    assert reach.texels.tolist() == [False, True, True, False, True, False]
    stars = [reach.stars[start:end].tolist() for start, end in zip(reach.starts, reach.starts[1:], strict=False)]
    assert stars == [[0], [0, 1], [0, 1, 2], [1], [2], [2]]


def arrays(splats: Splats) -> dict[str, Array]:
    return {name: value for name, value in vars(splats).items() if isinstance(value, np.ndarray)}


@pytest.fixture
def avatar() -> Avatar:
    plain = synthetic_avatar()
    return with_expressions(with_one_sided(plain, np.arange(len(plain.rig.texels.texels)) % 2 == 0))


def without(avatar: Avatar) -> Avatar:
    clips = tuple(replace(clip, expressions=None) for clip in avatar.clips)
    return replace(avatar, rig=replace(avatar.rig, expressions=None), clips=clips)


@pytest.mark.parametrize("level", [0, 1, 2])
@pytest.mark.parametrize("named", [{}, {"jawOpen": 0.0}, {"nothing": 1.0}])
def test_weights_of_0_give_the_bytes_of_the_avatar_without(avatar: Avatar, level: int, named: dict[str, float]) -> None:
    found = arrays(avatar.at_level(level).decode("wave", 3, expressions=named))
    for name, values in arrays(without(avatar).at_level(level).decode("wave", 3)).items():
        assert found[name].tobytes() == values.tobytes(), name


@pytest.mark.parametrize("level", [0, 1, 2])
def test_only_texels_in_reach_change_and_they_do(avatar: Avatar, level: int) -> None:
    top = np.array([9, 10, 11])
    crown = Expressions(("crown",), np.array([0, 3]), top, np.random.default_rng(7).normal(0, 0.1, (3, 3)))
    shown = replace(without(avatar), rig=replace(avatar.rig, expressions=crown)).at_level(level)
    plain, spoken = (shown.decode("wave", 3, expressions=named) for named in ({}, {"crown": 0.7}))
    near = reach_of(top, shown.rig.mesh.faces, shown.rig.texels.triangles).texels
    far = ~near
    assert near.any()
    assert far.any()
    for name in ("centres", "rotations", "scales", "normals"):
        before, after = arrays(plain)[name], arrays(spoken)[name]
        assert after[far].tobytes() == before[far].tobytes(), name
        if name != "normals":
            assert (after[near] != before[near]).any(axis=1).all(), name
    assert spoken.texel_dq.tobytes() == plain.texel_dq.tobytes()
    np.testing.assert_array_equal(np.flatnonzero((spoken.mesh != plain.mesh).any(axis=1)), top)


def test_colours_become_brighter_by_a_share_of_them(avatar: Avatar) -> None:
    """Alike from all sides; by what the corners of a texel's triangle have, and without light not at all."""
    held, weights = avatar.rig.expressions, {"jawOpen": 0.7, "Mund auf": 0.5}
    assert held is not None
    assert held.gains is not None
    unlit = replace(avatar, rig=replace(avatar.rig, expressions=replace(held, gains=None)))
    plain, found = (one.decode("wave", 3, expressions=weights, dtype=np.float64).texture for one in (unlit, avatar))
    gains = np.zeros(len(avatar.rig.mesh.vertices))
    for name, weight in weights.items():
        entries = slice(*held.starts[[held.names.index(name), held.names.index(name) + 1]])
        gains[held.vertices[entries]] += weight * held.gains[entries]
    texels = avatar.rig.texels
    share = np.sum(texels.barycentrics * gains[avatar.rig.mesh.faces[texels.triangles]], axis=1)
    colours, before = (0.5 + 0.28209479177387814 * texture[:, 11:14] for texture in (found, plain))
    np.testing.assert_allclose(colours, before * (1 + share[:, None]), rtol=0, atol=1e-6)
    assert np.abs(share).max() > 0.1
    others = np.delete(np.arange(23), [11, 12, 13])
    assert found[:, others].tobytes() == plain[:, others].tobytes()
    assert found[share == 0].tobytes() == plain[share == 0].tobytes()


def test_a_clip_moves_the_face_by_its_weights_at_any_rate(avatar: Avatar) -> None:
    for rate in (24.0, 30.0):
        clip = replace(avatar.clips[0], rate=rate)
        played = resample(clip, 24.0)
        assert played.expressions is not None
        shown = avatar.decode(clip, 4)
        weights = dict(zip(avatar.expressions, played.expressions[4], strict=True))
        expected = avatar.decode(replace(clip, expressions=None), 4, expressions=weights)
        np.testing.assert_array_equal(shown.centres, expected.centres)
        assert (shown.centres != avatar.decode(clip, 4, expressions={}).centres).any()


def test_a_window_moves_the_face_by_its_newest_pose(avatar: Avatar) -> None:
    clip = avatar.clips[0]
    poses = [clip.pose(frame) for frame in (3, 2, 1)]
    older = [poses[0], *(Pose(pose.rotations, pose.translations) for pose in poses[1:])]
    assert avatar.decode(poses).centres.tobytes() == avatar.decode("wave", 3).centres.tobytes()
    assert avatar.decode(older).centres.tobytes() == avatar.decode("wave", 3).centres.tobytes()


def test_weights_beyond_0_and_1_are_held_there(avatar: Avatar) -> None:
    for given, held in ((7.0, 1.0), (-3.0, 0.0)):
        found, expected = (avatar.decode("wave", 3, expressions={"jawOpen": weight}) for weight in (given, held))
        assert found.centres.tobytes() == expected.centres.tobytes()


def test_rules_hold_back_weights_of_clips_and_those_that_are_given(avatar: Avatar) -> None:
    ruled, clip = with_rules(avatar), resample(avatar.clips[0], avatar.encoding.rate)
    assert clip.expressions is not None
    assert ruled.rig.expressions
    for number, weights in enumerate((clip.expressions[4], np.array([0, 1, 1, 0.75]))):
        given, left = (
            dict(zip(avatar.expressions, values.tolist(), strict=True))
            for values in (weights, ruled.rig.expressions.shown(weights))
        )
        found = ruled.decode(clip, 4, expressions=given if number else None)
        assert found.centres.tobytes() == avatar.decode(clip, 4, expressions=left).centres.tobytes()
        assert found.centres.tobytes() != avatar.decode(clip, 4, expressions=given).centres.tobytes()
    blink = ruled.decode(clip, 4, expressions={"eyeBlinkLeft": 1, "Mund auf": 1})
    assert blink.texture.tobytes() == ruled.decode(clip, 4, expressions={"Mund auf": 0.6}).texture.tobytes()


def test_names_that_the_avatar_lacks_move_the_nearest_that_it_has(avatar: Avatar) -> None:
    own = {"jawOpen": 0.5 * 0.7, "eyeBlinkLeft": 0.25}
    found, expected = (avatar.decode("wave", 3, expressions=weights) for weights in ({"aa": 0.5, "blink": 0.25}, own))
    np.testing.assert_allclose(found.centres, expected.centres, rtol=0, atol=1e-6)
    assert found.centres.tobytes() != avatar.decode("wave", 3, expressions={}).centres.tobytes()


def test_wrong_weights_are_refused_in_a_sentence(avatar: Avatar) -> None:
    with pytest.raises(InputError, match="expression is 'smile'; the avatar's expressions: jawOpen, eyeBlinkLeft"):
        avatar.decode("wave", 3, expressions={"smile": 1.0})
    with pytest.raises(InputError, match="weight of expression 'jawOpen': a value is not finite"):
        avatar.decode("wave", 3, expressions={"jawOpen": float("nan")})
    with pytest.raises(InputError, match=r"expressions of clip 'wave': the shape is \[7, 2\], expected \[7, 4\]"):
        avatar.decode(replace(avatar.clips[0], expressions=np.zeros((7, 2))), 3)
    with pytest.raises(InputError, match="expression is 'jawOpen'; the avatar's expressions: none"):
        without(avatar).decode("wave", 3, expressions={"jawOpen": 1.0})


def test_a_mesh_and_its_texels_move_together(avatar: Avatar) -> None:
    """An expression that turns all of the figure is a turn of all splats."""
    rig, turn = avatar.rig, Rotation.from_euler("xyz", [0.4, 0.3, -0.2])
    mesh, texture = rig.mesh.vertices, np.random.default_rng(5).normal(size=(len(rig.texels.texels), 23))
    count = len(mesh)
    whole = Expressions(("turn",), np.array([0, count]), np.arange(count), turn.apply(mesh) - mesh)
    moved, bent = express(replace(rig, expressions=whole), mesh, texture=texture, weights=np.ones(1))
    np.testing.assert_allclose(moved, turn.apply(mesh), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(bent[:, 0:3], turn.apply(texture[:, 0:3]), rtol=0, atol=1e-9)
    found = rotation.to_matrix(rotation.normalize(bent[:, 3:7]))
    own = rotation.to_matrix(rotation.normalize(texture[:, 3:7]))
    np.testing.assert_allclose(found, turn.as_matrix() @ own, rtol=0, atol=1e-9)
