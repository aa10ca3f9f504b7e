"""FBX characters and motion, posed as glTF ones of the same figure are."""

from collections.abc import Callable
from pathlib import Path

import fbx_files
import numpy as np
import pytest
from fbx_files import Fbx, binds, figure, layer, skeleton, skinned
from gltf_files import BONES, POINTS, TRIANGLES, Glb, animate, assert_is_column, body, posed
from gltf_files import read as read_glb

from mua import rotation
from mua.atlas.character_surfaces import Surfaces
from mua.characters.fbx.process import scenes_of
from mua.characters.read import read_animation, read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion
from mua.pose.signed_expressions import UNIT

FRAMES = 7
ANGLES = 9.0 * np.arange(FRAMES)  # degrees, of the spine about X
RATE = 30
BOUND = 1e-5  # metres


def turns(axis: tuple[float, float, float], angles: np.ndarray = ANGLES) -> np.ndarray:
    return rotation.from_axis_angle(np.broadcast_to(axis, (len(angles), 3)), np.radians(angles))


def bent(glb: Glb) -> Glb:
    """The glTF column whose spine bends about X."""
    quaternions = np.roll(turns((1, 0, 0)), -1, axis=1)
    animate(glb, 1, "rotation", times=np.arange(FRAMES) / RATE, values=quaternions, name="bend")
    return glb


def keyed(fbx: Fbx, spine: int, axis: int = 0, sign: int = 1, name: str = "bend") -> None:
    """The same bend as Euler angles of the spine about one of its axes."""
    keys = np.zeros((FRAMES, 3))
    keys[:, axis] = sign * ANGLES
    fbx.animate(fbx.stack(name, FRAMES), spine, "Lcl Rotation", keys)


def frames(surfaces: Surfaces, clip: int = 0) -> np.ndarray:
    """Vertices [frames, V, 3] of a clip, ordered by their place in the bind pose."""
    order = np.lexsort(np.round(surfaces.vertices, 4).T)
    found = surfaces.clips[clip]
    moving = [posed(surfaces, *pose) for pose in zip(found.rotations, found.translations, strict=True)]
    return np.stack(moving)[:, order]


def plain() -> Fbx:
    fbx, bones, _ = figure()
    keyed(fbx, bones[1])
    return fbx


def in_centimetres() -> Fbx:
    fbx, bones, _ = figure(unit=1.0)
    keyed(fbx, bones[1])
    return fbx


def with_z_up() -> Fbx:
    fbx, bones, _ = figure(unit=2.54, z_up=True)
    keyed(fbx, bones[1])
    return fbx


def with_pre_rotation() -> Fbx:
    """The spine's axes turned by 90 degrees about Z, the head's turned back; the world's X is then the spine's -Y."""
    fbx = Fbx()
    hips = fbx.model("hips", "LimbNode")
    turned = {"RotationActive": 1, "PreRotation": (0, 0, 90)}
    spine = fbx.model("spine", "LimbNode", hips, Lcl_Translation=(0, 0.5, 0), **turned)
    back = {"RotationActive": 1, "PreRotation": (0, 0, 30), "PostRotation": (0, 0, 120)}
    head = fbx.model("head", "LimbNode", spine, Lcl_Translation=(0.5, 0, 0), **back)
    bound = binds(fbx)
    bound[1, :3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    skinned(fbx, [hips, spine, head], bound)
    keyed(fbx, spine, axis=1, sign=-1)
    return fbx


def with_geometric_transform() -> Fbx:
    fbx = Fbx()
    bones = skeleton(fbx)
    body = fbx.model("body", "Mesh", GeometricTranslation=(0.5, 1, 0), GeometricScaling=(2, 2, 2))
    fbx.skin(fbx.mesh(body, (POINTS - (0.5, 1, 0)) / 2), bones, binds(fbx), weights=np.eye(3)[fbx_files.BONES])
    keyed(fbx, bones[1])
    return fbx


def at_rest_in_another_pose() -> Fbx:
    fbx = Fbx()
    bones = [fbx.model("hips", "LimbNode")]
    bones.append(fbx.model("spine", "LimbNode", bones[0], Lcl_Translation=(0, 0.5, 0), Lcl_Rotation=(50, 20, -10)))
    bones.append(fbx.model("head", "LimbNode", bones[1], Lcl_Translation=(0, 0.5, 0), Lcl_Rotation=(-15, 0, 5)))
    skinned(fbx, bones)
    clip = fbx.stack("bend", FRAMES)
    fbx.animate(clip, bones[1], "Lcl Rotation", np.stack([ANGLES, 0 * ANGLES, 0 * ANGLES], axis=1))
    fbx.animate(clip, bones[2], "Lcl Rotation", np.zeros((FRAMES, 3)))
    return fbx


def in_two_meshes() -> Fbx:
    fbx = Fbx()
    bones = skeleton(fbx)
    skinned(fbx, bones)
    skinned(fbx, bones)
    keyed(fbx, bones[1])
    return fbx


MADE = [plain, in_centimetres, with_z_up, with_pre_rotation, with_geometric_transform, at_rest_in_another_pose]


@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
@pytest.mark.parametrize("make", MADE, ids=lambda make: make.__name__)
def test_is_posed_as_the_same_figure_in_gltf(make: Callable[[], Fbx], binary: bool, tmp_path: Path) -> None:
    read = read_surfaces(make().save(tmp_path / "body.fbx", binary=binary))
    assert_is_column(read, BOUND)
    assert (read.clips[0].name, read.clips[0].rate) == ("bend", RATE)
    np.testing.assert_allclose(frames(read), frames(read_glb(bent(body()), tmp_path)), atol=BOUND)


def test_two_skins_on_one_skeleton_are_both_posed(tmp_path: Path) -> None:
    read = read_surfaces(in_two_meshes().save(tmp_path / "body.fbx"))
    expected = frames(read_glb(bent(body()), tmp_path))
    np.testing.assert_allclose(frames(read), np.repeat(expected, 2, axis=1), atol=BOUND)


def test_several_skins_of_one_mesh_act_as_one(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    mesh, weights = fbx.mesh(fbx.model("body", "Mesh"), POINTS), np.eye(3)[fbx_files.BONES]
    fbx.skin(mesh, bones[:2], binds(fbx)[:2], weights=weights[:, :2])
    fbx.skin(mesh, bones[1:], binds(fbx)[1:], weights=weights[:, 1:])
    keyed(fbx, bones[1])
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert not any("without weights" in note for note in read.notes)
    np.testing.assert_allclose(frames(read), frames(read_glb(bent(body()), tmp_path)), atol=BOUND)


def test_each_stack_is_a_clip_of_its_name(tmp_path: Path) -> None:
    fbx, bones, _ = figure()
    keyed(fbx, bones[1], name="Body|bend")
    keyed(fbx, bones[1], sign=-1, name="Body|lean")
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert [clip.name for clip in read.clips] == ["Body|bend", "Body|lean"]
    assert abs(frames(read, 0)[-1, :, 2] - frames(read, 1)[-1, :, 2]).max() > 0.5


def test_layers_of_a_stack_are_added(tmp_path: Path) -> None:
    fbx, bones, _ = figure()
    first = fbx.stack("bend", FRAMES)
    fbx.animate(first, bones[1], "Lcl Rotation", np.outer(ANGLES / 3, (1, 0, 0)))
    stack = next(parent for kind, child, parent, *_ in fbx.links if child == first)
    second = fbx.add("AnimationLayer", "more", "", to=stack)
    fbx.animate(second, bones[1], "Lcl Rotation", np.outer(ANGLES * 2 / 3, (1, 0, 0)))
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    np.testing.assert_allclose(frames(read), frames(read_glb(bent(body()), tmp_path)), atol=BOUND)


def test_a_mesh_below_a_bone_moves_with_it(tmp_path: Path) -> None:
    fbx, bones, _ = figure(unit=1.0)
    hat = fbx.model("hat", "Mesh", bones[2], Lcl_Translation=(0, 60.0, 0))
    fbx.mesh(hat, 0.2 * POINTS)
    keyed(fbx, bones[1])
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert any("rigidly" in note and "hat" in note for note in read.notes)
    angle = np.radians(ANGLES[-1])
    c, s = np.cos(angle), np.sin(angle)
    placed = 0.2 * POINTS + (0, 1.1, 0)  # half a metre of it turns with the spine
    expected = placed @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]]).T + (0, 0.5, 0)
    found = frames(read)[-1]
    nearest = np.linalg.norm(found[:, None] - expected, axis=-1).min(axis=0)
    np.testing.assert_allclose(nearest, 0, atol=BOUND)


def test_vertices_without_weights_keep_to_the_skeleton(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    weights = np.eye(3)[fbx_files.BONES]
    weights[:4] = 0
    fbx.skin(fbx.mesh(fbx.model("body", "Mesh"), POINTS), bones, binds(fbx), weights=weights)
    keyed(fbx, bones[1])
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert any("without weights" in note for note in read.notes)
    np.testing.assert_allclose(frames(read), frames(read_glb(bent(body()), tmp_path)), atol=BOUND)


def test_all_influences_of_a_vertex_are_read(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx) + [fbx.model(f"extra{k}", "LimbNode") for k in range(3)]
    bound = np.concatenate([binds(fbx), np.tile(np.eye(4), (3, 1, 1))])
    weights = np.full((len(POINTS), 6), 1 / 6)
    fbx.skin(fbx.mesh(fbx.model("body", "Mesh"), POINTS), bones, bound, weights=weights)
    (scene,) = scenes_of(fbx.save(tmp_path / "body.fbx"), "skinned")
    np.testing.assert_allclose(scene.parts[0].weights, 1 / 6)
    assert (np.sort(scene.parts[0].joints, axis=1) == np.arange(6)).all()


def test_a_bone_that_does_not_inherit_scale_keeps_its_size(tmp_path: Path) -> None:
    fbx = Fbx()
    hips = fbx.model("hips", "LimbNode", Lcl_Scaling=(2, 2, 2))
    spine = fbx.model("spine", "LimbNode", hips, Lcl_Translation=(0, 0.5, 0), InheritType=2)
    head = fbx.model("head", "LimbNode", spine, Lcl_Translation=(0, 0.5, 0))
    skinned(fbx, [hips, spine, head])
    keyed(fbx, spine)
    (scene,) = scenes_of(fbx.save(tmp_path / "body.fbx"), "skinned")
    (part,), skin = scene.parts, scene.skins[0]
    worlds = (scene.motions[0].worlds[0][skin.joints] @ skin.inverse_binds)[part.joints[:, 0]]
    found = np.einsum("nij,nj->ni", worlds[:, :3, :3], part.positions) + worlds[:, :3, 3]
    expected = POINTS + np.array([0, 0.5, 0])
    expected[:4] = 2 * POINTS[:4]
    np.testing.assert_allclose(found, expected, atol=BOUND)


def blend_shape(fbx: Fbx, name: str, points: int, *, percent: float = 0.0) -> int:
    """A shape that moves the first points of the only mesh by 1 along each axis; returns its channel."""
    geometry = next(node.values[0] for node in fbx.objects if node.name == "Geometry")
    shape = fbx.add("Deformer", "face", "BlendShape", to=geometry)
    channel = fbx.add("Deformer", name, "BlendShapeChannel", fbx_files.Node("DeformPercent", (percent,)), to=shape)
    indices = fbx_files.Node("Indexes", (np.arange(points, dtype=np.int32),))
    fbx.add("Geometry", name, "Shape", indices, fbx_files.Node("Vertices", (np.ones(3 * points),)), to=channel)
    return channel


def test_dual_quaternions_are_noted_and_blend_shapes_read(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    skinned(fbx, bones, kind="DualQuaternion")
    blend_shape(fbx, "smile", 2)
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert any("dual quaternions" in note for note in read.notes)
    assert_is_column(read, BOUND)
    assert read.expressions is not None
    assert read.expressions.names == ("smile",)
    moved = read.expressions.displacement(np.ones(1), vertices=len(read.vertices))
    rows = [int(np.abs(read.vertices - point).sum(axis=1).argmin()) for point in POINTS[:2]]
    np.testing.assert_allclose(moved[rows], 1, atol=BOUND)
    assert np.count_nonzero(moved.any(axis=1)) == 2


def test_blend_shapes_count_from_their_weights_at_rest(tmp_path: Path) -> None:
    fbx = Fbx()
    skinned(fbx, skeleton(fbx))
    blend_shape(fbx, "smile", 16, percent=25.0)
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert read.expressions is not None
    np.testing.assert_allclose(read.expressions.offsets, 0.75, atol=BOUND)
    np.testing.assert_allclose(read.vertices[read.faces].min(axis=(0, 1)), POINTS.min(axis=0) + 0.25, atol=BOUND)


def test_shape_keys_of_smplx_move_both_ways(tmp_path: Path) -> None:
    fbx = Fbx()
    skinned(fbx, skeleton(fbx))
    channel = blend_shape(fbx, "Exp000", 16)
    percent = 100 * UNIT * np.linspace(-1, 2, FRAMES)[:, None]
    fbx.animate(fbx.stack("talk", FRAMES), channel, "DeformPercent", percent, ["DeformPercent"])
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert read.expressions is not None
    assert read.expressions.names == ("Exp000+", "Exp000-")
    np.testing.assert_allclose(np.abs(read.expressions.offsets), UNIT, atol=BOUND)
    expected = np.clip([np.linspace(-1, 2, FRAMES), -np.linspace(-1, 2, FRAMES)], 0, 1).T
    np.testing.assert_allclose(np.asarray(read.clips[0].expressions), expected, atol=1e-5)


def test_hidden_meshes_are_left_out(tmp_path: Path) -> None:
    fbx, bones, _ = figure()
    fbx.mesh(fbx.model("proxy", "Mesh", bones[0], Visibility=0), POINTS)
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    assert any("hides" in note and "proxy" in note for note in read.notes)
    assert_is_column(read, BOUND)


def test_hiding_every_mesh_means_nothing(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    body = fbx.model("body", "Mesh", Visibility=0)
    fbx.skin(fbx.mesh(body, POINTS), bones, binds(fbx), weights=np.eye(3)[fbx_files.BONES])
    assert_is_column(read_surfaces(fbx.save(tmp_path / "body.fbx")), BOUND)


def test_a_quad_that_is_not_convex_is_cut_inside(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    body = fbx.model("body", "Mesh")
    corners = np.array([[0, 0, 0], [1, 1.2, 0], [0, 0.4, 0], [-1, 1.2, 0]])  # an arrowhead
    ring = [fbx_files.Node("Vertices", (corners.ravel(),))]
    ring.append(fbx_files.Node("PolygonVertexIndex", (np.array([3, 0, 1, ~2], np.int32),)))
    geometry = fbx.add("Geometry", "", "Mesh", *ring, to=body)
    fbx.skin(geometry, bones[:1], binds(fbx)[:1], weights=np.ones((4, 1)))
    read = read_surfaces(fbx.save(tmp_path / "body.fbx"))
    first, second, third = (read.vertices[read.faces[:, corner]] for corner in range(3))
    cross = np.cross(second - first, third - first)
    assert abs(cross[:, 2]).sum() / 2 == pytest.approx(0.4)


def test_motion_without_a_mesh_has_all_joints(tmp_path: Path) -> None:
    fbx = Fbx(unit=1.0)
    bones = skeleton(fbx)
    keyed(fbx, bones[1])
    (motion,) = read_motion(fbx.save(tmp_path / "bend.fbx"))
    assert motion.skeleton.names == fbx_files.JOINTS
    assert (motion.clip.name, len(motion.clip.rotations)) == ("bend", FRAMES)
    with pytest.raises(InputError, match=r"no skinned mesh .* if it holds motion alone, give it with --motion"):
        read_surfaces(tmp_path / "bend.fbx")


@pytest.mark.parametrize("kind", ["fbx", "glb"])
def test_motion_whose_mesh_is_a_face_alone_has_all_joints_that_move(kind: str, tmp_path: Path) -> None:
    if kind == "fbx":
        fbx = Fbx()
        bones = skeleton(fbx)
        body_node = fbx.model("face", "Mesh")
        fbx.skin(fbx.mesh(body_node, POINTS), bones[2:], binds(fbx)[2:], weights=np.ones((len(POINTS), 1)))
        keyed(fbx, bones[1])
        path = fbx.save(tmp_path / "bend.fbx")
    else:
        glb = bent(body())
        glb.json["nodes"][3] |= {"name": "face"}
        del glb.json["nodes"][3]["skin"], glb.json["skins"]
        for name in ("JOINTS_0", "WEIGHTS_0"):
            del glb.json["meshes"][0]["primitives"][0]["attributes"][name]
        glb.json["scenes"] = [{"nodes": [0]}]
        glb.json["nodes"][2]["children"] = [3]
        path = glb.save(tmp_path / "bend.glb")
    read = read_animation(path)
    assert set(fbx_files.JOINTS) <= set(read.skeleton.names)


def test_a_figure_without_a_skeleton_is_refused(tmp_path: Path) -> None:
    fbx = Fbx()
    fbx.mesh(fbx.model("statue", "Mesh"), POINTS)
    with pytest.raises(InputError, match=r"statue\.fbx: no skinned mesh .* add a skeleton in Blender"):
        read_surfaces(fbx.save(tmp_path / "statue.fbx"))


def with_stray_weights(count: int) -> Fbx:
    """The column, whose skin has weights of `count` vertices more than the mesh has."""
    fbx = Fbx()
    bones = skeleton(fbx)
    weights = np.concatenate([np.eye(3)[BONES], np.tile([1.0, 0, 0], (count, 1))])
    fbx.skin(fbx.mesh(fbx.model("body", "Mesh"), POINTS), bones, binds(fbx), weights=weights)
    return fbx


def test_the_skin_of_another_mesh_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"mesh body: the cluster of hips has weights for vertex 20, of 16 vertices"):
        read_surfaces(with_stray_weights(5).save(tmp_path / "body.fbx"))


def test_a_stray_weight_is_left_out_with_a_note(tmp_path: Path) -> None:
    read, sound = (read_surfaces(with_stray_weights(count).save(tmp_path / "body.fbx")) for count in (1, 0))
    assert "Weights of vertices that the mesh does not have are left out, of meshes: body." in read.notes
    assert not any("left out" in note for note in sound.notes)
    np.testing.assert_array_equal(read.skin_indices, sound.skin_indices)
    np.testing.assert_array_equal(read.skin_weights, sound.skin_weights)


def test_a_stack_of_years_is_refused(tmp_path: Path) -> None:
    fbx, bones, _ = figure()
    clip = fbx.stack("long", 2_000_000_000)
    fbx.animate(clip, bones[1], "Lcl Rotation", [(0, 0, 0), (9, 0, 0)])
    with pytest.raises(InputError, match=r"animation stack long lasts .* frames of 1 nodes, expected at most"):
        read_surfaces(fbx.save(tmp_path / "body.fbx"))


def test_vertex_colours_are_multiplied_in(tmp_path: Path) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    corners = TRIANGLES.size
    red = np.tile((1.0, 0.5, 0.0, 0.0), (corners, 1))
    numbers = np.append(red, np.full((1, 4), np.nan))  # what no corner has is of no account
    colors = layer("Color", "ByPolygonVertex", Colors=numbers, ColorIndex=np.arange(corners, dtype=np.int32))
    fbx.skin(fbx.mesh(fbx.model("body", "Mesh"), POINTS, colors), bones, binds(fbx), weights=np.eye(3)[fbx_files.BONES])
    read = read_surfaces(fbx.save(tmp_path / "body.fbx", binary=True))
    assert read.corner_colors is not None
    np.testing.assert_allclose(read.corner_colors, np.broadcast_to((1, 0.2140, 0, 1), (*TRIANGLES.shape, 4)), atol=1e-3)
