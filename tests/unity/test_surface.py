"""The package's surfaces: the triangles that mono reads, and every pass of surface.shader, recorded and replayed.

Triangles are held against the desktop player's; images against those that numpy draws of the posed avatar.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rasterised
import wgpu
from csharp import PROGRAMS, ROOT, CSharp
from drawn import DEPTH_FORMAT, Target, UnityPainter
from rasterised import STROKES_BOUND, SURFACE_BOUND, Picture, Stroke, Wall, compare
from recorded_frames import eye_lines, place_of
from replay import Drawn, replay, value
from synthetic_avatar import sparse_avatar, synthetic_avatar, with_surface

from mua import rotation
from mua.arrays import Array
from mua.asset import read, write
from mua.asset.avatar import Avatar
from mua.avatar.camera import EYE_DISTANCE, Camera, orbit, stereo
from mua.avatar.decode import decode_clip_frame
from mua.gpu import Device
from mua.player.overlays import (
    BONE_COLOR,
    BONE_WIDTH,
    GEOMETRY_COLOR,
    JOINT_COLOR,
    JOINT_WIDTH,
    OUTLINE,
    OUTLINE_COLOR,
    TEMPLATE_COLOR,
)
from mua.player.surface import surface_mesh

SCREEN = (160, 200)
FRAME = 3  # a frame of the clip at 24 Hz
PLACE = (0.35, 0.1, -0.2, 0.1, 0.5, -0.1, 0.85446, 0.8)  # Unity's position, then rotation (x, y, z, w), then size
PASSES = ("Geometry", "Template", "Skeleton", "ShadowCaster")
VIEWS = PASSES[:3]
MAP = 512  # pixels along a shadow map
SUBPIXELS = 256  # to which the software device rounds places, along a pixel: its subPixelPrecisionBits are 8
STEEPEST = 2.3  # the slope of linear light over sRGB near white
METRES = 4.0  # that it spans


@pytest.fixture(scope="module")
def surface_program(csharp: CSharp) -> Path:
    sources = (PROGRAMS / "shared", PROGRAMS / "scenario", PROGRAMS / "SurfaceProgram.cs")
    return csharp.runtime(*sources, name="SurfaceProgram")


def arrays(path: Path) -> list[Array]:
    """Int32 arrays, each after its length."""
    words, found = np.fromfile(path, np.int32), list[Array]()
    while len(words):
        found.append(words[1 : 1 + words[0]])
        words = words[1 + words[0] :]
    return found


def test_triangles_and_those_about_each_texel_are_the_desktop_players(
    csharp: CSharp, surface_program: Path, tmp_path: Path
) -> None:
    write(tmp_path / "avatar.muaavatar", sparse_avatar(1))
    surface = surface_mesh(read(tmp_path / "avatar.muaavatar"))
    csharp.run(surface_program, "grid", tmp_path / "avatar.muaavatar", tmp_path / "grid")
    expected = (surface.triangles, surface.ring_starts, surface.ring)
    for found, exact in zip(arrays(tmp_path / "grid"), expected, strict=True):
        np.testing.assert_array_equal(found, exact.ravel().astype(np.int32))


def test_a_file_without_a_surface_is_told_in_a_sentence(csharp: CSharp, surface_program: Path, tmp_path: Path) -> None:
    printed = csharp.run(surface_program, "grid", ROOT / "tests" / "golden" / "synthetic.muaavatar", tmp_path / "grid")
    assert printed.strip() == "the file holds no surface to show; bake it again."


@dataclass(frozen=True)
class Scene:
    """What mono recorded of the second of two avatars."""

    avatar: Avatar
    cameras: tuple[Camera, ...]
    drawn: dict[str, Drawn]  # by pass
    printed: dict[str, list[int]]


@pytest.fixture(scope="module")
def scene(csharp: CSharp, surface_program: Path, device: Device, tmp_path_factory: pytest.TempPathFactory) -> Scene:
    folder = tmp_path_factory.mktemp("surface")
    files = [folder / f"{index}.muaavatar" for index in range(2)]
    for seed, file in enumerate(files):
        write(file, with_surface(synthetic_avatar(seed + 1)), storage="f32")
    avatar = read(files[1])
    centres = placed(posed(avatar).centres)
    bounds = np.stack([centres.min(axis=0), centres.max(axis=0)])
    cameras = stereo(orbit(bounds, screen=SCREEN, azimuth=0.7, elevation=0.3), EYE_DISTANCE)
    lines = eye_lines(cameras)
    lines.append(f"decode {(FRAME + 0.02) / 24!r} " + " ".join(map(repr, PLACE)))
    scenario = folder / "scenario.txt"
    scenario.write_text("\n".join(lines))
    printed = csharp.run(surface_program, "draw", ROOT / "ComputeShaders", folder / "recording", scenario, *files)
    draws = {PASSES[drawn.pass_index]: drawn for drawn in replay(device, folder / "recording").draws}
    spoken = {words[0]: [int(word) for word in words[1:]] for words in map(str.split, printed.splitlines())}
    return Scene(avatar, cameras, draws, spoken)


def posed(avatar: Avatar) -> Any:
    return decode_clip_frame(avatar, avatar.clips[0], frame=FRAME, dtype=np.float64)


@pytest.fixture
def painter(device: Device, tmp_path: Path, scene: Scene) -> "Painter":
    return Painter(device, tmp_path, scene)


class Painter(UnityPainter):
    """Draws views of a scene, as numpy does, too."""

    def __init__(self, device: Device, folder: Path, scene: Scene) -> None:
        super().__init__(device, folder, "surface.shader", SCREEN)
        self.scene = scene

    def view(self, name: str, *, variant: str = "mono", **more: Any) -> Array:
        """[H, W, 4] of one eye, rows as the target stores them."""
        drawn = self.scene.drawn[name]
        if variant == "instanced":
            drawn = replace(drawn, arguments=(drawn.arguments[0], 2))  # as the engine multiplies it
        return self.unity(drawn, variant=variant, **more)

    def expected(self, name: str, eye: int, *, wall: Wall | None = None) -> Picture:
        """What numpy draws of the posed avatar where it stands."""
        scene = self.scene
        rig, frame, camera = scene.avatar.rig, posed(scene.avatar), scene.cameras[eye]
        if name == "Geometry":
            triangles = surface_mesh(scene.avatar).triangles.astype(np.int64)
            return rasterised.smooth(camera, placed(frame.centres), triangles, GEOMETRY_COLOR, wall=wall)
        if name == "Template":
            return rasterised.flat(camera, placed(frame.mesh), rig.mesh.faces, TEMPLATE_COLOR, wall=wall)
        return rasterised.strokes(camera, self.strokes())

    def strokes(self) -> list[Stroke]:
        """The bones and joints where the avatar stands."""
        skeleton, clip = self.scene.avatar.rig.skeleton, self.scene.avatar.clips[0]
        _, joints = skeleton.world(clip.rotations[FRAME], clip.translations[FRAME])
        return list(skeleton_strokes(skeleton.parents, placed(joints)))


def skeleton_strokes(parents: Array, joints: Array) -> Iterator[Stroke]:
    """Bones and then joints, each with its outline before it."""
    bones = [joints[[child, parent]] for child, parent in enumerate(parents) if parent >= 0]
    dots = [joints[[joint, joint]] for joint in range(len(joints))]
    for lines, width, color in ((bones, BONE_WIDTH, BONE_COLOR), (dots, JOINT_WIDTH, JOINT_COLOR)):
        yield from (Stroke(ends, OUTLINE_COLOR, width + 2 * OUTLINE) for ends in lines)
        yield from (Stroke(ends, color, width) for ends in lines)


def placed(points: Array) -> Array:
    """Points of the avatar's own space where it stands, in the kernels' world."""
    return rotation.dual_transform(place_of(PLACE), PLACE[-1] * points)


def agree(found: Array, expected: Picture, name: str) -> None:
    compare(found, expected, STROKES_BOUND if name == "Skeleton" else SURFACE_BOUND)


@pytest.mark.parametrize("turned", [False, True], ids=["back buffer", "texture"])
@pytest.mark.parametrize("name", VIEWS)
def test_each_view_is_as_numpy_draws_it(painter: Painter, name: str, turned: bool) -> None:
    found = painter.view(name, turned=turned)
    agree(found[::-1] if turned else found, painter.expected(name, 0), name)


@pytest.mark.parametrize("eye", [0, 1])
@pytest.mark.parametrize("name", VIEWS)
def test_each_stereo_mode_draws_its_eye(painter: Painter, name: str, eye: int) -> None:
    expected = painter.expected(name, eye)
    agree(painter.view(name, variant="instanced", replayed_layer=eye), expected, name)
    agree(painter.view(name, variant="multiview", replayed_view=eye), expected, name)
    agree(painter.view(name, unity_StereoEyeIndex=eye), expected, name)
    with pytest.raises(AssertionError, match="pixels"):
        agree(painter.view(name, unity_StereoEyeIndex=1 - eye), expected, name)


@pytest.mark.parametrize("name", VIEWS)
def test_depth_hides_surfaces_but_no_bones(painter: Painter, name: str) -> None:
    """A plane through the avatar."""
    camera = painter.scene.cameras[0]
    centres = placed(posed(painter.scene.avatar).centres)
    distance = -(centres @ camera.view[2, :3] + camera.view[2, 3]).mean()
    found = painter.view(name, plane=depth_at(camera, distance))
    agree(found, painter.expected(name, 0, wall=Wall(distance)), name)
    assert np.array_equal(found, painter.view(name)) == (name == "Skeleton")


def depth_at(camera: Camera, distance: float) -> float:
    """What the device keeps of a distance along the camera's axis: from 1 near to 0 far."""
    row = camera.projection[2]
    return float(1 - (row[3] - row[2] * distance) / distance) / 2


def test_a_surface_yields_a_centimetre_to_what_lies_on_it(painter: Painter) -> None:
    """A wall so little behind a facet hides it, a wall farther behind does not."""
    scene, camera = painter.scene, painter.scene.cameras[0]
    mesh = placed(posed(scene.avatar).mesh)
    corners = mesh[scene.avatar.rig.mesh.faces] @ camera.view[:3, :3].T + camera.view[:3, 3]
    middles = corners.mean(axis=1)
    clip = middles @ camera.projection[:, :3].T + camera.projection[:, 3]
    columns, rows = ((clip[:, :2] / clip[:, 3:] * [1, -1] + 1) / 2 * SCREEN).astype(int).T
    facet = np.argmin(np.where(columns < SCREEN[0] // 2 - 2, -middles[:, 2], np.inf))  # the nearest before the wall
    place, focal = np.array([columns[facet], rows[facet]]) + 0.5, np.diagonal(camera.projection)[:2]
    ray = np.append(((2 * place / SCREEN - 1) * [1, -1] + camera.projection[:2, 2]) / focal, -1)  # a metre deep
    normal = np.cross(*(corners[facet, 1:] - corners[facet, 0]))
    depth = middles[facet] @ normal / (ray @ normal)  # where the ray through the pixel's middle meets the facet
    seen = []
    for behind in (0.005, 0.015):
        image = painter.view("Template", plane=depth_at(camera, depth + behind))
        seen.append(bool(image[rows[facet], columns[facet], 3]))
    assert seen == [False, True]


@pytest.mark.parametrize("name", ["Geometry", "Template"])
def test_a_linear_project_is_given_light(painter: Painter, name: str) -> None:
    srgb = painter.expected(name, 0)
    image = np.concatenate([light_of(srgb.image[..., :3]), srgb.image[..., 3:]], axis=-1)
    agree(painter.view(name, space=()), Picture(image, STEEPEST * srgb.spread), name)


def test_a_linear_project_blends_the_light_of_bones(painter: Painter) -> None:
    lit = [replace(stroke, color=tuple(light_of(np.array(stroke.color)))) for stroke in painter.strokes()]
    agree(painter.view("Skeleton", space=()), rasterised.strokes(painter.scene.cameras[0], lit), "Skeleton")


def light_of(srgb: Array) -> Array:
    """IEC 61966-2-1."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def light_from(axis: int, span: float, middle: float = 0) -> Array:
    """Unity's world to the clip space of a light along an axis; depth runs from 1 to 0 over a span about its middle."""
    across, up = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.zeros((4, 4))
    matrix[0, across] = matrix[1, up] = 2 / METRES
    matrix[2, axis], matrix[2, 3] = -1 / span, 0.5 + middle / span
    matrix[3, 3] = 1
    return matrix


def shadow_depths(painter: Painter, matrix: Array) -> Array:
    """[MAP, MAP] depth of the vertices that the shadow pass draws as points; 0 where there is none."""
    drawn = painter.scene.drawn["ShadowCaster"]
    program = painter.passes[drawn.pass_index]
    text = program.text + "\nfloat4 DepthFrag(float4 at : SV_Position) : SV_Target { return float4(at.z, 0, 0, 1); }\n"
    path = replace(program, text=text).write(painter.folder)
    states: dict[str, Any] = {
        "color_format": "rgba32float",
        "depth_format": DEPTH_FORMAT,
        "blend": False,
        "topology": "point-list",
    }
    states |= {"depth_write": True, "depth_compare": "greater-equal"}
    pipeline = painter.device.pipeline(path, program.vertex, "DepthFrag", **states)
    names = {slot.name for stage in pipeline.stages for slot in stage.buffers}
    buffers = {name: painter.device.buffer(drawn.buffers[name], name=name) for name in names}
    (slot,) = (stage.constants["size"] for stage in pipeline.stages if "size" in stage.constants)
    size = value("ShadowCaster", slot, *drawn.constants["size"])

    def draw(render_pass: wgpu.GPURenderPassEncoder) -> None:
        pipeline.bind(render_pass, buffers, unity_MatrixVP=matrix, size=size)
        render_pass.draw(len(painter.scene.avatar.rig.mesh.vertices))

    target = Target(painter.device, "rgba32float", (MAP, MAP), 0.0, painter.folder)
    return np.asarray(target.image(draw)[..., 0])


@pytest.mark.parametrize("axis", range(3))
def test_shadows_are_cast_by_the_posed_template_in_unitys_world(painter: Painter, axis: int) -> None:
    """A light along each axis: its depths are a coordinate of every vertex, its pixels the two others."""
    world = placed(posed(painter.scene.avatar).mesh) * [-1, 1, 1]
    clip = np.column_stack([world, np.ones(len(world))]) @ light_from(axis, METRES).T
    pixels = np.rint((clip[:, :2] * [1, -1] + 1) / 2 * MAP * SUBPIXELS) / SUBPIXELS
    column, row = np.ceil(pixels).astype(int).T - 1  # a point on the edge of two belongs to the one before it
    depths = shadow_depths(painter, light_from(axis, METRES))
    assert len(world) // 2 < np.count_nonzero(depths) <= len(world)
    nearest = np.array([clip[(column == c) & (row == r), 2].max() for c, r in zip(column, row, strict=True)])
    np.testing.assert_allclose(depths[row, column], nearest, atol=2e-6)  # float32 of a few operations on metres


def test_what_lies_before_a_lights_volume_still_casts_a_shadow(painter: Painter) -> None:
    world = placed(posed(painter.scene.avatar).mesh) * [-1, 1, 1]
    span, middle = 0.5, world[:, 1].mean()  # metres; the avatar reaches farther to both sides
    depth = 0.5 - (world[:, 1] - middle) / span
    depths = shadow_depths(painter, light_from(1, span, middle))
    assert np.any(depth > 1)
    assert np.count_nonzero(depths == 1) == np.count_nonzero(depth > 1)


def test_draws_of_indices(scene: Scene) -> None:
    faces = scene.avatar.rig.mesh.faces.ravel()
    surface = surface_mesh(scene.avatar)
    for name in ("Template", "ShadowCaster"):
        np.testing.assert_array_equal(scene.drawn[name].indices, faces)
        assert scene.drawn[name].arguments == (faces.size, 1)
    np.testing.assert_array_equal(scene.drawn["Geometry"].indices, surface.triangles.ravel())
    assert scene.drawn["Skeleton"].arguments == (6 * 2 * (2 + 3), 1)  # two bones, three joints, and their outlines


def test_a_view_costs_nothing_until_it_is_wanted(scene: Scene) -> None:
    assert scene.printed["idle"] == [0, 0, 0]  # buffers, draws for the engine, draws for cameras
    assert scene.printed["first"][0] >= 2  # the grid may still be under way
    assert scene.printed["made"][0] == scene.printed["again"][0] == 6  # ring, its starts, two of indices, rest, strokes


def test_an_editor_that_does_not_play_shows_the_geometry_at_once(scene: Scene) -> None:
    assert scene.printed["still"] == [1]


def test_frames_allocate_nothing_and_leave_nothing_behind(scene: Scene) -> None:
    assert scene.printed["allocated"] == [0]
    assert scene.printed["alive"] == [0]
