"""Overlays are drawn at the numpy reference's places of surface, joints and shadow."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import rasterised
import wgpu
from rasterised import STROKES_BOUND, SURFACE_BOUND, Picture, Stroke, compare
from scipy.ndimage import map_coordinates
from synthetic_avatar import empty_avatar, synthetic_avatar, with_surface

from mua import rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.write import write
from mua.avatar.camera import Camera, orbit, stereo
from mua.avatar.decode import Splats, decode_clip_frame
from mua.errors import InputError
from mua.gpu import Device
from mua.kernels.dq_skinning import blend_vertices
from mua.player.buffers import AvatarBuffers
from mua.player.draw import read_image, view_projection
from mua.player.frame import AvatarFrame
from mua.player.overlays import (
    BONE_COLOR,
    BONE_WIDTH,
    DARKNESS,
    GEOMETRY_COLOR,
    JOINT_COLOR,
    JOINT_WIDTH,
    LIGHT,
    MASK_ROW,
    MASK_SIZE,
    OUTLINE,
    OUTLINE_COLOR,
    TEMPLATE_COLOR,
    ground_height,
    shadow_area,
)
from mua.player.scene import Scene, draw_picture
from mua.player.splats import SplatFrame
from mua.player.surface import surface_mesh
from mua.player.toggles import Toggles, parse_toggles
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose

SCREEN = (97, 131)  # pixels
HALF = 2.0**-11  # relative rounding of a half float: the image's format
INDEX = 3  # frame of the clip
COVER = """
#include "surface_draw.hlsl"
StructuredBuffer<uint> mask;
cbuffer Constants { uint size; float samples; float first; };
float4 CoverVert(uint vertex : SV_VertexID) : SV_Position
{
    return float4(vertex == 1 ? 3 : -1, vertex == 2 ? 3 : -1, 0, 1);
}
float4 CoverFrag(float4 at : SV_Position) : SV_Target { return shadowCover(first + at.xy * samples, size, mask); }
"""


class Stage:
    """The synthetic avatar at one frame of its clip, on the device and by the reference."""

    def __init__(self, device: Device, path: Path) -> None:
        self.device = device
        write(path, with_surface(synthetic_avatar()), storage="f32")
        self.avatar = read(path)
        self.gpu = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, path))])
        self.scene = Scene(device, self.gpu)
        self.clip = self.avatar.clips[0]
        self.window = self.avatar.encoding.frames(INDEX)
        self.ground = ground_height(self.avatar.rig, self.clip)
        self.frame: Splats = decode_clip_frame(self.avatar, self.clip, frame=INDEX, dtype=np.float64)

    def picture(self, cameras: tuple[Camera, ...], show: str) -> Array:
        commands = self.device.commands()
        self.gpu.avatars[0].decode(commands, self.clip.rotations[self.window], self.clip.translations[self.window])
        self.gpu.sort(commands, cameras)
        commands.submit()
        self.scene.pose(self.clip.rotations[INDEX], self.clip.translations[INDEX], ground=self.ground)
        return draw_picture(self.device, self.scene, cameras, parse_toggles(show))


@pytest.fixture(scope="module")
def stage(device: Device, tmp_path_factory: pytest.TempPathFactory) -> Stage:
    return Stage(device, tmp_path_factory.mktemp("overlays") / "synthetic.muaavatar")


def camera_at(points: Array, *, azimuth: float = 0.0, elevation: float = 0.0) -> Camera:
    return orbit(
        np.stack([points.min(axis=0), points.max(axis=0)]), screen=SCREEN, azimuth=azimuth, elevation=elevation
    )


def pixels(camera: Camera, points: Array) -> Array:
    """Column and row [P, 2] of points in the world."""
    clip = np.column_stack([points, np.ones(len(points))]) @ view_projection(camera).T
    return (clip[:, :2] / clip[:, 3:] * [1, -1] + 1) / 2 * SCREEN


def drawn_box(image: Array) -> Array:
    """First column and row, and one past the last, of what is drawn."""
    rows, columns = np.nonzero(image[..., 3])
    return np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1])


def expected(stage: Stage, camera: Camera, show: str) -> Picture:
    """numpy's image of the reference's posed splats, template or joints."""
    rig = stage.avatar.rig
    if show == "geometry":
        triangles = surface_mesh(stage.avatar).triangles.astype(np.int64)
        return rasterised.smooth(camera, stage.frame.centres, triangles, GEOMETRY_COLOR)
    if show == "template":
        return rasterised.flat(camera, stage.frame.mesh, rig.mesh.faces, TEMPLATE_COLOR)
    _, joints = rig.skeleton.world(stage.clip.rotations[INDEX], stage.clip.translations[INDEX])
    bones = [joints[[child, parent]] for child, parent in enumerate(rig.skeleton.parents) if parent >= 0]
    dots = [joints[[joint, joint]] for joint in range(len(joints))]
    styles = (
        (bones, OUTLINE_COLOR, BONE_WIDTH + 2 * OUTLINE),
        (bones, BONE_COLOR, BONE_WIDTH),
        (dots, OUTLINE_COLOR, JOINT_WIDTH + 2 * OUTLINE),
        (dots, JOINT_COLOR, JOINT_WIDTH),
    )
    return rasterised.strokes(camera, [Stroke(ends, color, width) for lines, color, width in styles for ends in lines])


@pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 0.0), (1.6, 0.4), (3.1, -0.9), (4.7, 1.5)])
@pytest.mark.parametrize("show", ["geometry", "template", "skeleton"])
def test_draws_the_picture_that_numpy_draws(stage: Stage, show: str, azimuth: float, elevation: float) -> None:
    camera = camera_at(stage.frame.centres, azimuth=azimuth, elevation=elevation)
    bound = STROKES_BOUND if show == "skeleton" else SURFACE_BOUND
    compare(stage.picture((camera,), show), expected(stage, camera, show), bound)


def test_draws_every_joint_over_all_else(stage: Stage) -> None:
    camera = camera_at(stage.frame.centres)
    image = stage.picture((camera,), "splats,geometry,template,skeleton")
    _, joints = stage.avatar.rig.skeleton.world(stage.clip.rotations[INDEX], stage.clip.translations[INDEX])
    assert len(joints) == 3
    for column, row in pixels(camera, joints).astype(int):
        np.testing.assert_allclose(image[row, column, :3], JOINT_COLOR, atol=HALF)


@pytest.mark.parametrize("near", [1, 0.1])  # share of the distances by which the bone passes
@pytest.mark.parametrize("side", [-1, 1])
def test_a_bone_that_passes_the_camera_is_drawn_to_where_it_leaves_the_picture(
    stage: Stage, side: int, near: float
) -> None:
    """One joint before the camera, the other behind: every point between them that is in the image is drawn."""
    _, joints = stage.avatar.rig.skeleton.world(stage.clip.rotations[INDEX], stage.clip.translations[INDEX])
    behind, ahead = joints[1:3][::side]
    along = (ahead - behind) / np.linalg.norm(ahead - behind)
    across = rotation.normalize(np.cross(along, [1.0, 0.2, 0.1]))
    up = np.cross(across, along)
    look = np.cos(0.27) * along - np.sin(0.27) * across  # so that the bone's direction in the image shows its end
    turn = np.stack([np.cross(look, up), up, -look])
    view = np.eye(4)
    view[:3, :3], view[:3, 3] = turn, -turn @ (0.75 * behind + 0.25 * ahead) + [-0.03 * near, -0.04 * near, 0]
    camera = replace(camera_at(joints), view=view)
    between = behind + np.linspace(0, 1, 2000)[:, None] * (ahead - behind)
    before = between[(between @ view[2, :3] + view[2, 3]) < -2 * near * camera.near]
    at = pixels(camera, before)
    inside = at[((at > 2) & (at < np.array(SCREEN) - 2)).all(axis=1)].astype(int)
    assert np.ptp(inside, axis=0).max() > 20
    image = stage.picture((camera,), "skeleton")
    assert (image[inside[:, 1], inside[:, 0], 3] > 0.5).all()


def test_a_bone_behind_the_camera_is_not_drawn(stage: Stage) -> None:
    """The eye looks straight away from the middle of the bone."""
    _, joints = stage.avatar.rig.skeleton.world(stage.clip.rotations[INDEX], stage.clip.translations[INDEX])
    along = (joints[2] - joints[1]) / np.linalg.norm(joints[2] - joints[1])
    look = rotation.normalize(np.cross(along, [1.0, 0.2, 0.1]))
    for sign, is_seen in ((1, True), (-1, False)):
        back = -sign * look
        turn = np.stack([np.cross(along, back), along, back])
        view = np.eye(4)
        view[:3, :3], view[:3, 3] = turn, -turn @ ((joints[1] + joints[2]) / 2 - 2 * look)
        image = stage.picture((replace(camera_at(joints), view=view),), "skeleton")
        assert bool(np.any(image[..., 3])) == is_seen


@pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 1.5), (2.2, 0.6), (4.7, 0.1)])
def test_casts_the_shadow_that_numpy_casts(stage: Stage, azimuth: float, elevation: float) -> None:
    """Walls that overlap darken once."""
    root = stage.avatar.rig.skeleton.root
    _, joints = stage.avatar.rig.skeleton.world(stage.clip.rotations[INDEX], stage.clip.translations[INDEX])
    camera = camera_at(stage.frame.mesh - np.array([0, 0.3, 0]), azimuth=azimuth, elevation=elevation)
    cast = rasterised.shadow(
        camera,
        stage.frame.mesh,
        stage.avatar.rig.mesh.faces,
        light=np.array(LIGHT),
        area=shadow_area(stage.avatar.bounds + joints[root], stage.ground),
        size=MASK_SIZE,
        darkness=DARKNESS,
    )
    compare(stage.picture((camera,), "shadow"), cast, SURFACE_BOUND)


def test_a_shadow_fades_where_its_mask_ends(device: Device, tmp_path: Path) -> None:
    """A mask that is full of numbers up to its edges, read from three samples before it to three behind it."""
    size, side, samples = 8, 64, 14 / 64
    mask = np.random.default_rng(3).integers(0, 256, (size, size), np.uint8)
    path = tmp_path / "cover.hlsl"
    path.write_text(COVER)
    drawing = device.pipeline(
        path, "CoverVert", "CoverFrag", color_format="rgba32float", depth_format=None, blend=False
    )
    usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
    target = device.wgpu.create_texture(size=(side, side, 1), format="rgba32float", usage=usage)
    encoder = device.wgpu.create_command_encoder()
    attachment = {"view": target.create_view(), "load_op": "clear", "store_op": "store"}
    render_pass = encoder.begin_render_pass(color_attachments=[attachment])
    rows_apart = np.pad(mask, ((0, 0), (0, MASK_ROW - size)), constant_values=255)
    held = device.buffer(rows_apart.view(np.uint32), name="mask")
    drawing.bind(render_pass, {"mask": held}, size=size, samples=samples, first=-3.0)
    render_pass.draw(3)
    render_pass.end()
    device.wgpu.queue.submit([encoder.finish()])
    at = (np.arange(side) + 0.5) * samples - 3 - 0.5  # from the first sample's middle
    rows, columns = np.meshgrid(at, at, indexing="ij")
    exact = map_coordinates(mask / 255, [rows, columns], order=3, mode="grid-constant", prefilter=False)
    np.testing.assert_allclose(read_image(device, target)[..., 0], exact, atol=1e-5)  # float32 of 16 products


def test_hides_splats_behind_the_surface(stage: Stage) -> None:
    camera = camera_at(stage.frame.centres)
    both = stage.picture((camera,), "splats,geometry")
    alone = stage.picture((camera,), "splats")
    surface = stage.picture((camera,), "geometry")
    covered = surface[..., 3] == 1
    np.testing.assert_allclose(both[covered][:, 3], 1, atol=2 * HALF)
    assert np.abs(both - alone)[covered].max() > 0.01  # the surface shines through between splats
    assert np.abs(both - surface)[covered].max() > 0.01  # splats on the near wall still cover it
    assert np.abs(both - alone)[covered].max(axis=1).mean() < 0.01  # also those that lie a few millimetres in it


def test_gives_each_eye_its_own_picture(stage: Stage) -> None:
    show = "geometry,template,skeleton,shadow"
    camera = camera_at(stage.frame.centres, elevation=0.3)
    eyes = stereo(camera, 0.063)
    pair = stage.picture(eyes, show)
    alone = np.hstack([stage.picture((eye,), show) for eye in eyes])
    differs = (np.abs(pair - alone) > 2 * HALF).any(axis=2)
    # a pixel's centre within a device's subpixel of an edge may fall to either side once the viewport moves
    assert differs.mean() < 1 / 256


def test_shows_nothing_where_nothing_is_chosen(stage: Stage) -> None:
    camera = camera_at(stage.frame.centres)
    assert stage.picture((camera,), "splats")[..., 3].max() > 0
    assert draw_picture(stage.device, stage.scene, (camera,), Toggles(splats=False)).max() == 0


@pytest.mark.parametrize("show", ["geometry", "template", "skeleton", "shadow", "splats,geometry,skeleton,shadow"])
def test_draws_from_inside_the_body_and_on_one_pixel(stage: Stage, show: str) -> None:
    middle = stage.frame.centres.mean(axis=0)
    inside = orbit(np.stack([middle, middle]), screen=SCREEN)
    assert np.isfinite(stage.picture((inside,), show)).all()
    pixel = orbit(np.stack([stage.frame.centres.min(axis=0), stage.frame.centres.max(axis=0)]), screen=(1, 1))
    assert stage.picture((pixel,), show).shape == (1, 1, 4)


def test_names_what_can_be_shown() -> None:
    assert parse_toggles("geometry, shadow") == Toggles(splats=False, geometry=True, shadow=True)
    with pytest.raises(InputError, match="--show is 'splat'; expected some of splats, geometry, template"):
        parse_toggles("splat")


def test_finds_the_shadow_of_every_corner_inside_the_square() -> None:
    bounds = np.array([[-0.4, 0.0, -0.3], [0.5, 1.8, 0.2]])
    low_x, low_z, side, ground = shadow_area(bounds, 0.1)
    corners = np.array(np.meshgrid(*bounds.T)).reshape(3, -1).T
    fallen = corners - np.array(LIGHT) * ((corners[:, 1:2] - ground) / LIGHT[1])
    assert ((fallen[:, [0, 2]] > [low_x, low_z]) & (fallen[:, [0, 2]] < [low_x + side, low_z + side])).all()


def still(avatar: Avatar, heights: Array) -> Clip:
    """The rest pose, its root moved up by each height."""
    pose: Pose = avatar.rig.skeleton.bind_pose
    skeleton = avatar.rig.skeleton
    translations = skeleton.with_root(pose.translations[skeleton.root] + np.outer(heights, [0, 1.0, 0]))
    return Clip("still", 24.0, np.tile(pose.rotations, (len(heights), 1, 1)), translations)


def test_stands_the_ground_under_most_frames() -> None:
    avatar = synthetic_avatar()
    rig = avatar.rig
    joints = rig.skeleton.skinning(rig.skeleton.bind_pose.rotations, rig.skeleton.bind_pose.translations)
    rest = rotation.dual_transform(blend_vertices(joints, rig.skin_indices, rig.skin_weights), rig.mesh.vertices)
    lowest = rest[:, 1].min()
    assert ground_height(rig, None) == pytest.approx(rig.mesh.vertices[:, 1].min())
    leaping = np.where(np.arange(31) % 3 == 0, 0.2, 0.7)
    leaping[7] = -0.5  # one frame strays below
    assert ground_height(rig, still(avatar, leaping)) == pytest.approx(lowest + 0.2, abs=1e-6)


def test_draws_an_avatar_without_texels(device: Device, tmp_path: Path) -> None:
    avatar = empty_avatar()
    write(tmp_path / "empty.muaavatar", avatar)
    frame = AvatarFrame(device, AvatarBuffers(device, tmp_path / "empty.muaavatar"))
    scene = Scene(device, SplatFrame(device, [frame]))
    camera = camera_at(avatar.rig.mesh.vertices)
    picture = draw_picture(device, scene, (camera,), Toggles(splats=False, geometry=True))
    assert picture.max() == 0
    assert picture.shape == (SCREEN[1], SCREEN[0], 4)


def test_draws_into_targets_of_changing_size(stage: Stage) -> None:
    for screen in [(5, 7), (64, 3), (5, 7)]:
        camera = replace(camera_at(stage.frame.centres), screen=screen)
        assert stage.picture((camera,), "geometry,shadow").shape == (screen[1], screen[0], 4)
