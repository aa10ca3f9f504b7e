"""Scenes built by hand, merged into one surface on rigid joints."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.errors import InputError
from mua.rig.assemble import Surfaces, assemble, first_of_equal, limit_influences
from mua.rig.correction import ADULT
from mua.rig.figure_size import FigureSize
from mua.rig.resize import resized
from mua.rig.scene import Material, Motion, Part, Scene, Skin
from mua.teachers.simulated import stretched

HERE = Path("body.glb")
GREY = Material("grey", np.full((1, 1, 4), 128, np.uint8))
# Double precision, coordinates about 2, chains of a dozen 4x4 products.
DOUBLE_BOUND = 2 * 12 * 4 * 2**-52
# Weights are float32, which a vertex of about 2 metres feels in full.
WEIGHT_BOUND = 2 * 8 * 2**-24


def at(x: float, y: float, z: float, turn: Rotation | None = None, scale: float = 1.0) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = (Rotation.identity() if turn is None else turn).as_matrix() * scale
    matrix[:3, 3] = x, y, z
    return matrix


NAMES = ("hips", "spine", "head", "arm_l", "arm_r")
PARENTS = np.array([-1, 0, 1, 1, 1])
BIND = np.stack([at(0, 0.9, 0), at(0, 1.2, 0), at(0, 1.6, 0), at(0.2, 1.4, 0), at(-0.2, 1.4, 0)])


def part(*, group: int = 0, skin: int = 0, seed: int = 0, count: int = 30) -> Part:
    """A soup of triangles over the whole body, each vertex on two joints."""
    generator = np.random.default_rng(seed)
    positions = generator.uniform([-0.4, 0, -0.1], [0.4, 1.8, 0.1], (count, 3))
    joints = np.stack([np.arange(count) % 5, (np.arange(count) + 1) % 5], axis=1)
    weights = np.stack([np.full(count, 0.75), np.full(count, 0.25)], axis=1)
    faces = np.arange(count).reshape(-1, 3)
    uv = generator.uniform(-1, 2, (count, 2))
    return Part(f"part{group}", group, positions, faces, uv, faces, 0, skin, joints, weights)


def scene(**changes: object) -> Scene:
    skin = Skin(np.arange(5), np.linalg.inv(BIND))
    whole = Scene("body", NAMES, PARENTS, BIND, (skin,), (part(),), (GREY,), (), ())
    return replace(whole, **changes)


def moving(rest: np.ndarray, parents: np.ndarray, *, hips: bool = True, frames: int = 9) -> Motion:
    """Every joint turns about its own axis; the hips also travel."""
    generator = np.random.default_rng(7)
    axes = generator.normal(size=(len(rest), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    worlds = np.zeros((frames, *rest.shape))
    for f in range(frames):
        for j, parent in enumerate(parents):
            local = rest[j] if parent < 0 else np.linalg.inv(rest[parent]) @ rest[j]
            turn = at(0, 0, 0, Rotation.from_rotvec(0.1 * f * axes[j]))
            shift = at(0.1 * f if hips and parent < 0 else 0, 0, 0)
            worlds[f, j] = (np.eye(4) if parent < 0 else worlds[f, parent]) @ shift @ local @ turn
    return Motion("dance", 30.0, worlds)


def posed(surfaces: Surfaces, rotations: np.ndarray, translations: np.ndarray) -> np.ndarray:
    """Vertices blended linearly from rigid joints."""
    transforms = surfaces.skeleton.skinning(rotations, translations)
    return sum(
        surfaces.skin_weights[:, k, None].astype(float)
        * rotation.dual_transform(transforms[surfaces.skin_indices[:, k]], surfaces.vertices)
        for k in range(8)
    )


def skinned(whole: Scene, frame: int) -> np.ndarray:
    """Corners [F, 3, 3] by the source's own matrices: the definition of linear blend skinning."""
    corners = []
    for piece in whole.parts:
        skin = whole.skins[piece.skin]
        matrices = whole.motions[0].worlds[frame, skin.joints] @ skin.inverse_binds
        points = np.concatenate([piece.positions, np.ones((len(piece.positions), 1))], axis=1)
        moved = np.einsum("nk,nkij,nj->ni", piece.weights, matrices[piece.joints], points)[:, :3]
        corners.append(moved[piece.faces])
    return np.concatenate(corners)


def assert_follows(whole: Scene, surfaces: Surfaces, bound: float = WEIGHT_BOUND) -> None:
    (clip,) = surfaces.clips
    for frame in (0, 4, 8):
        ours = posed(surfaces, clip.rotations[frame], clip.translations[frame])[surfaces.faces]
        np.testing.assert_allclose(ours, skinned(whole, frame), atol=bound)


def test_bind_pose_reproduces_the_bind_vertices() -> None:
    surfaces = assemble(scene(), HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=DOUBLE_BOUND)
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=WEIGHT_BOUND)


def test_clip_follows_the_sources_matrices() -> None:
    whole = scene(motions=(moving(BIND, PARENTS),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert not surfaces.notes


def test_skins_bound_in_other_spaces_meet() -> None:
    space = at(3, -2, 1, Rotation.from_euler("xyz", [40, 50, 60], degrees=True), scale=250)
    other = replace(part(group=1, skin=1, seed=3), positions=_moved(np.linalg.inv(space), part(seed=3).positions))
    skins = (scene().skins[0], Skin(np.arange(5), np.linalg.inv(BIND) @ space))
    whole = scene(skins=skins, parts=(part(), other), motions=(moving(BIND, PARENTS),))
    surfaces = assemble(whole, HERE)
    expected = np.concatenate([part().positions[part().faces], part(seed=3).positions[part().faces]])
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], expected, atol=1000 * DOUBLE_BOUND)
    assert_follows(whole, surfaces)


def test_skins_bound_in_other_poses_meet_in_the_first() -> None:
    bent = BIND.copy()
    bent[2] = BIND[1] @ at(0, 0, 0, Rotation.from_rotvec([0.5, 0, 0])) @ np.linalg.inv(BIND[1]) @ BIND[2]
    skins = (scene().skins[0], Skin(np.arange(5), np.linalg.inv(bent)))
    whole = scene(skins=skins, parts=(part(), part(group=1, skin=1, seed=3)), motions=(moving(BIND, PARENTS),))
    rigid = replace(whole.parts[1], weights=np.tile([1.0, 0.0], (30, 1)))  # blends of two poses differ by their nature
    whole = replace(whole, parts=(whole.parts[0], rigid))
    assert_follows(whole, assemble(whole, HERE))


@pytest.mark.parametrize("scale", [(1.0, 2.0, 0.5), (0.01, 0.01, 0.01)])
def test_scales_of_joints_leave_the_pose_alone(scale: tuple[float, float, float]) -> None:
    stretch = np.diag([*scale, 1])
    bind = BIND @ stretch
    motion = moving(BIND, PARENTS)
    whole = scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        motions=(replace(motion, worlds=motion.worlds @ stretch),),
    )
    surfaces = assemble(whole, HERE)
    np.testing.assert_allclose(surfaces.skeleton.bind_translations[1], [0, 0.3, 0], atol=DOUBLE_BOUND)
    assert_follows(whole, surfaces)


def test_scale_added_after_binding_is_folded_into_the_mesh() -> None:
    stretch = np.diag([2.0, 1.5, 0.5, 1])
    bigger_head = BIND.copy()
    bigger_head[2] = BIND[2] @ stretch
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    worlds[:, 2] = worlds[:, 2] @ stretch
    whole_weights = replace(part(), weights=np.tile([1.0, 0.0], (30, 1)))  # a blend of scales is not one of rotations
    whole = scene(rest=bigger_head, parts=(whole_weights,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert not surfaces.notes


def test_mirrored_mesh_keeps_its_outside() -> None:
    mirror = np.diag([-1.0, 1, 1, 1])
    mirrored = replace(part(), positions=part().positions * [-1, 1, 1])
    surfaces = assemble(scene(skins=(Skin(np.arange(5), np.linalg.inv(BIND) @ mirror),), parts=(mirrored,)), HERE)
    turned = part().faces[:, [0, 2, 1]]
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[turned], atol=DOUBLE_BOUND)


def test_z_up_mesh_stands_up_although_the_rest_pose_is_another() -> None:
    z_up = at(0, 0, 0, Rotation.from_rotvec([-np.pi / 2, 0, 0]), scale=0.01)
    motion = moving(BIND, PARENTS)
    whole = scene(
        rest=motion.worlds[5],
        skins=(Skin(np.arange(5), np.linalg.inv(BIND) @ z_up),),
        parts=(replace(part(), positions=_moved(np.linalg.inv(z_up), part().positions)),),
        motions=(motion,),
    )
    surfaces = assemble(whole, HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=1e-12)
    assert_follows(whole, surfaces)


def test_joints_moved_by_controls_hang_on_what_carries_them() -> None:
    """The arms follow the spine by a constraint; in the file they hang on an unbound control at the origin."""
    names = ("control", *NAMES)
    parents = np.array([-1, -1, 1, 2, 0, 0])
    motion = moving(BIND, PARENTS)
    control = np.tile(np.eye(4), (len(motion.worlds), 1, 1, 1))
    whole = scene(
        node_names=names,
        parents=parents,
        rest=np.concatenate([np.eye(4)[None], BIND]),
        skins=(Skin(np.arange(6), np.concatenate([at(9, 9, 9)[None], np.linalg.inv(BIND)])),),
        parts=(replace(part(), joints=part().joints + 1),),
        motions=(replace(motion, worlds=np.concatenate([control, motion.worlds], axis=1)),),
    )
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    skeleton = surfaces.skeleton
    assert set(skeleton.names) == set(NAMES)
    for arm in ("arm_l", "arm_r"):
        assert skeleton.names[skeleton.parents[skeleton.names.index(arm)]] == "spine"
    assert "hang on others" in surfaces.notes[0]


def test_joints_that_leave_their_places_are_followed() -> None:
    """Limbs that grow longer, a head that comes off: no joint of the file carries them, and none needs to."""
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    for joint in (2, 4):
        worlds[:, joint] = np.stack([at(0.05 * f, 0.1 * f, -0.02 * joint * f) for f in range(9)]) @ worlds[:, joint]
    whole = scene(motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert surfaces.notes == ()


def test_scaled_joints_stretch_the_surface_as_in_the_source() -> None:
    """Squash and stretch of joints that also turn, with vertices of one joint each, which no blending blurs."""
    motion = moving(BIND, PARENTS)
    squash = np.stack([np.diag([1 + 0.02 * f, 1 - 0.04 * f, 1 + 0.02 * f, 1]) for f in range(9)])
    worlds = motion.worlds.copy()
    worlds[:, 1] = worlds[:, 1] @ squash
    for child in (2, 3, 4):  # what hangs on a scaled joint is scaled and moved with it
        worlds[:, child] = worlds[:, 1] @ np.linalg.inv(motion.worlds[:, 1]) @ motion.worlds[:, child]
    rigid = replace(part(), weights=np.tile([1.0, 0.0], (30, 1)))
    whole = scene(parts=(rigid,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    (clip,) = surfaces.clips
    assert clip.stretches is not None
    assert clip.stretches.joints.tolist() == [1, 2, 3, 4]
    for frame in (0, 4, 8):
        vertices = stretched(surfaces, clip.stretches, frame, surfaces.vertices)  # type: ignore[arg-type]
        shaped = replace(surfaces, vertices=vertices)
        ours = posed(shaped, clip.rotations[frame], clip.translations[frame])[surfaces.faces]
        np.testing.assert_allclose(ours, skinned(whole, frame), atol=WEIGHT_BOUND)
    assert "the largest is 32 %" in surfaces.notes[-1]


def test_what_is_steered_from_above_the_root_is_led_by_the_body() -> None:
    """A foot that hangs beside the travelling hips, as rigs with inverse kinematics have it."""
    parents = np.array([-1, 0, 1, 1, 0])
    motion = moving(BIND, parents, hips=False)
    worlds = motion.worlds.copy()
    for f in range(9):
        worlds[f, 1:4] = at(0.2 * f, 0, 0) @ worlds[f, 1:4]
        worlds[f, 4] = at(0.2 * f, 0, 0.3 * np.sin(f)) @ worlds[f, 4]
    weighted = replace(part(), joints=1 + part().joints % 4)
    whole = scene(parents=parents, parts=(weighted,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    skeleton = surfaces.skeleton
    assert skeleton.names[skeleton.root] == NAMES[1]
    assert skeleton.root in skeleton.ancestors(skeleton.names.index(NAMES[4]))
    assert surfaces.notes == ("1 joints hang on others than in the file, as the clips show.",)


def test_parents_come_before_children() -> None:
    parents = assemble(scene(motions=(moving(BIND, PARENTS),)), HERE).skeleton.parents
    assert all(parent < joint for joint, parent in enumerate(parents))


def test_moved_ancestor_of_two_skeletons_becomes_a_joint() -> None:
    """A moving carriage with two roots: neither root alone can carry the motion of both."""
    parents = np.array([-1, 0, 0])
    rest = np.stack([np.eye(4), at(0, 1, 0), at(0.5, 1.5, 0)])
    worlds = np.stack([at(0.2 * f, 0, 0) @ rest for f in range(9)])
    worlds[:, 1] = worlds[:, 1] @ np.stack([at(0, 0.1 * f, 0) for f in range(9)])
    piece = replace(part(), joints=np.tile(np.arange(30)[:, None] % 2, (1, 2)))
    whole = scene(
        node_names=("carriage", "left one", "other"),
        parents=parents,
        rest=rest,
        skins=(Skin(np.array([1, 2]), np.linalg.inv(rest[1:])),),
        parts=(piece,),
        motions=(Motion("roll", 30.0, worlds),),
    )
    assert "carriage" in assemble(whole, HERE).skeleton.names


def test_hips_are_the_root_of_a_still_character() -> None:
    surfaces = assemble(scene(node_names=("Armature", "mixamorig:Hips", "c", "d", "e")), HERE)
    assert surfaces.skeleton.names[surfaces.skeleton.root] in ("Armature", "mixamorig:Hips")
    above = replace(part(), joints=np.minimum(part().joints + 1, 4))
    surfaces = assemble(scene(node_names=("Armature", "mixamorig:Hips", "c", "d", "e"), parts=(above,)), HERE)
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "mixamorig:Hips"


def in_units(unit: float) -> Scene:
    """The scene as a file of so many units a metre holds it, with a clip."""
    bind = BIND.copy()
    bind[:, :3, 3] *= unit
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    worlds[..., :3, 3] *= unit
    return scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        parts=(replace(part(), positions=part().positions * unit),),
        motions=(replace(motion, worlds=worlds),),
    )


@pytest.mark.parametrize(("unit", "told"), [(100.0, 0.01), (1000.0, 0.001), (0.01, 100.0)])
def test_implausible_height_is_brought_to_metres_and_told(unit: float, told: float) -> None:
    surfaces = assemble(in_units(unit), HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=1e-12)
    assert f"one unit is taken as {told:g} m" in surfaces.notes[0]
    assert "--scale" in surfaces.notes[0]
    assert "--height" in surfaces.notes[0]
    np.testing.assert_allclose(surfaces.clips[0].translations[-1, surfaces.skeleton.root], [0.8, 0.9, 0], atol=1e-12)


def high(surfaces: Surfaces) -> float:
    return float(np.ptp(surfaces.vertices[:, 1]))


@pytest.mark.parametrize("unit", [1e-6, 1e5])
def test_a_height_that_no_unit_explains_is_made_that_of_an_adult_and_told(unit: float) -> None:
    surfaces = assemble(in_units(unit), HERE)
    assert high(surfaces) == pytest.approx(ADULT)
    assert f"it is made {ADULT} m high. --height METRES" in surfaces.notes[0]


def test_a_figure_that_creeps_is_not_taken_for_a_small_one() -> None:
    flat = part().positions * [1, 0.03, 1]
    surfaces = assemble(scene(parts=(replace(part(), positions=flat),)), HERE)
    assert surfaces.unit == 1
    assert surfaces.size_notes == ()


def test_a_giant_keeps_its_size_and_is_told() -> None:
    surfaces = assemble(in_units(15 / high(assemble(scene(), HERE))), HERE)
    assert high(surfaces) == pytest.approx(15)
    assert "is 15 m high, as few creatures are, and is left so. --height METRES" in surfaces.notes[0]


@pytest.mark.parametrize("height", [0.02, 2.0, 40.0])
def test_an_asked_height_scales_skeleton_surface_and_clips_alike(height: float) -> None:
    found = assemble(in_units(100.0), HERE)
    made = resized(found, FigureSize(height=height), HERE)
    factor = height / high(found)
    assert high(made) == pytest.approx(height)
    np.testing.assert_allclose(made.skeleton.bind_translations, factor * found.skeleton.bind_translations)
    np.testing.assert_allclose(made.clips[0].translations, factor * found.clips[0].translations)
    assert not any("unit" in note for note in made.notes)


def test_an_asked_scale_multiplies_the_units_of_the_file_not_those_guessed() -> None:
    found = assemble(in_units(100.0), HERE)  # taken as centimetres
    made = resized(found, FigureSize(scale=0.02), HERE)
    assert high(made) == pytest.approx(2 * high(found))


def test_a_scale_that_leaves_no_possible_size_is_refused() -> None:
    with pytest.raises(InputError, match=r"--scale 1e-05: makes the character of .* measure .* expected 0.01 to 100"):
        resized(assemble(scene(), HERE), FigureSize(scale=1e-5), HERE)


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ({"scale": 2.0, "height": 1.0}, "--scale 2 and --height 1: expected one of them"),
        ({"scale": 0.0}, "--scale 0: expected a number above 0"),
        ({"scale": -1.0}, "--scale -1: expected a number above 0"),
        ({"scale": float("nan")}, "--scale nan: expected a number above 0"),
        ({"scale": float("inf")}, "--scale inf: expected a number above 0"),
        ({"height": 0.0}, "--height 0: expected 0.01 to 100 metres"),
        ({"height": 101.0}, "--height 101: expected 0.01 to 100 metres"),
        ({"height": float("nan")}, "--height nan: expected 0.01 to 100 metres"),
    ],
)
def test_impossible_sizes_are_refused(asked: dict[str, float], told: str) -> None:
    with pytest.raises(InputError, match=re.escape(told)):
        FigureSize(**asked)


@pytest.mark.parametrize("degrees", [0, 30, 90, 180, 270])
def test_character_is_turned_to_face_forward(degrees: int) -> None:
    away = at(0, 0, 0, Rotation.from_euler("y", degrees, degrees=True))
    bind = away @ BIND
    whole = scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        parts=(replace(part(), positions=_moved(away, part().positions)),),
    )
    surfaces = assemble(whole, HERE)
    left = surfaces.skeleton.world(surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_pose.translations)[1][3]
    assert left[0] > 0.15
    assert bool(surfaces.notes) == (degrees >= 90)


def test_keeps_the_eight_largest_influences() -> None:
    generator = np.random.default_rng(1)
    weights = generator.dirichlet(np.ones(13), size=7)
    joints = np.stack([generator.permutation(20)[:13] for _ in range(7)])
    indices, kept, lost = limit_influences(joints, weights)
    for row in range(7):
        best = np.argsort(-weights[row])[:8]
        np.testing.assert_array_equal(indices[row], joints[row, best])
        np.testing.assert_allclose(kept[row], weights[row, best] / weights[row, best].sum(), atol=DOUBLE_BOUND)
    assert lost == pytest.approx(1 - np.sort(weights, axis=1)[:, -8:].sum(axis=1).min())


def test_a_joint_named_twice_counts_once() -> None:
    indices, kept, lost = limit_influences(np.array([[4, 2, 4, 0]]), np.array([[0.3, 0.4, 0.3, 0.0]]))
    assert indices.tolist() == [[4, 2, 0, 0, 0, 0, 0, 0]]
    np.testing.assert_allclose(kept[0, :3], [0.6, 0.4, 0])
    assert lost == pytest.approx(0)


def test_more_than_eight_influences_are_told() -> None:
    joints = np.tile(np.arange(9), (30, 1))
    names = tuple(f"bone{k}" for k in range(9))
    bind = np.tile(at(0, 1, 0), (9, 1, 1))
    whole = scene(
        node_names=names,
        parents=np.arange(-1, 8),
        rest=bind,
        skins=(Skin(np.arange(9), np.linalg.inv(bind)),),
        parts=(replace(part(), joints=joints, weights=np.full((30, 9), 1 / 9)),),
    )
    assert assemble(whole, HERE).notes == (
        "Mesh part0 has vertices with more than 8 influences; up to 11 % of a vertex's weight is dropped.",
    )


def test_vertex_without_weight_goes_to_its_first_joint() -> None:
    surfaces = assemble(scene(parts=(replace(part(), weights=np.zeros((30, 2))),)), HERE)
    np.testing.assert_array_equal(surfaces.skin_indices[surfaces.faces.ravel(), 0], np.arange(30) % 5)


def test_welds_equal_vertices_of_a_mesh_only() -> None:
    twice = (part(), part(), part(group=1))
    surfaces = assemble(scene(parts=twice), HERE)
    assert len(surfaces.vertices) == 60  # the copy in the same mesh is gone, the one in another stays
    assert len(surfaces.faces) == 20
    assert surfaces.notes == ("10 triangles that lie on others are dropped.",)


def test_other_weights_keep_vertices_apart() -> None:
    other = replace(part(), weights=part().weights[:, ::-1])
    assert len(assemble(scene(parts=(part(), other)), HERE).vertices) == 60


def test_seams_keep_their_texture_coordinates() -> None:
    positions = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
    uv = np.array([(0, 0), (1, 0), (0, 1), (1.5, 0), (0, 1), (1, 1)])
    faces = np.array([[0, 1, 2], [3, 5, 4]])
    quad = replace(
        part(count=6),
        positions=positions,
        faces=faces,
        uv=uv,
        uv_faces=faces,
        joints=np.zeros((6, 2), int),
    )
    surfaces = assemble(scene(parts=(quad,)), HERE)
    assert len(surfaces.vertices) == 4
    assert len(surfaces.uv) == 5  # (1, 0) is torn, (0, 1) is not
    np.testing.assert_array_equal(surfaces.uv[surfaces.uv_faces], uv[faces])


def test_triangles_that_welding_empties_are_dropped() -> None:
    thin = replace(part(), positions=np.concatenate([part().positions[:1], part().positions[:-1]]))
    thin = replace(thin, joints=np.zeros((30, 2), int))
    assert len(assemble(scene(parts=(thin,)), HERE).faces) == 9


def test_missing_texture_coordinates_are_marked() -> None:
    bare = replace(part(group=1, seed=2), uv=np.zeros((0, 2)), uv_faces=np.full((10, 3), -1))
    surfaces = assemble(scene(parts=(bare, part())), HERE)
    assert (surfaces.uv_faces[:10] == -1).all()
    np.testing.assert_array_equal(surfaces.uv[surfaces.uv_faces[10:]], part().uv[part().faces])


def test_unused_materials_are_left_out() -> None:
    other = Material("other", GREY.image)
    surfaces = assemble(scene(materials=(other, GREY), parts=(replace(part(), material=1),)), HERE)
    assert [material.name for material in surfaces.materials] == ["grey"]
    assert not surfaces.face_material.any()


def test_first_of_equal_keeps_the_order_of_appearance() -> None:
    first, which = first_of_equal(np.array([[3, 1], [2, 2], [3, 1], [0, 0]]))
    assert first.tolist() == [0, 1, 3]
    assert which.tolist() == [0, 1, 0, 2]


@pytest.mark.parametrize("parts", [(), (replace(part(), faces=np.zeros((0, 3), int), uv_faces=np.zeros((0, 3), int)),)])
def test_scene_without_triangles_is_refused(parts: tuple[Part, ...]) -> None:
    with pytest.raises(InputError, match=r"body\.glb: no skinned mesh"):
        assemble(scene(parts=parts), HERE)


def test_collapsed_mesh_and_joint_are_refused() -> None:
    with pytest.raises(InputError, match="all vertices of the skinned meshes lie at"):
        assemble(scene(parts=(replace(part(), positions=np.zeros((30, 3))),)), HERE)
    with pytest.raises(InputError, match="node spine has a scale of 0"):
        assemble(scene(rest=BIND * (np.arange(5) != 1)[:, None, None]), HERE)


def _moved(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]
