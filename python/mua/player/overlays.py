"""The overlays beside the splats: detailed geometry, template, skeleton, cast shadow (paper, section System)."""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import wgpu

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.gpu import Buffer, Device
from mua.gpu.draw import Pipeline
from mua.player.draw import view_projection
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.player.surface import surface_mesh
from mua.pose.clip import Clip
from mua.rig.bounds import frame_boxes, margin
from mua.rig.rig import Rig

SHADERS = Path(__file__).parent / "shaders"
GEOMETRY_COLOR = (0.80, 0.78, 0.75)  # sRGB
TEMPLATE_COLOR = (0.62, 0.72, 0.84)
BONE_COLOR = (0.98, 0.62, 0.12)
JOINT_COLOR = (1.0, 0.97, 0.90)
OUTLINE_COLOR = (0.12, 0.10, 0.08)
BONE_WIDTH, JOINT_WIDTH, OUTLINE = 2.5, 5.0, 1.5  # pixels; an outline is visible on any background

LIGHT = (-0.35, -1.0, -0.45)  # from above, the character's left and front: the shadow falls behind it
DARKNESS = 0.45  # opacity of the full shadow on the ground
MASK_SIZE = 128  # samples along the shadow's square: its edge is as soft as two of them
MASK_ROW = 256  # bytes from one row of samples to the next, MASK_ROW of surface_draw.hlsl
GROUND_FRAMES = 32  # frames of a clip in which the lowest point is sought
BELOW_GROUND = 0.1  # share of these that may reach below it: captured feet are noisy, and some clips leap or climb
MARGIN = 0.06  # margin round the shadow as a share of its size, so that its soft edge is not cut off


_Indices = tuple[wgpu.GPUBuffer, int]  # triangles' corners, and how many of these


class Overlays:
    """Draws around the splats of one avatar."""

    def __init__(self, device: Device, frame: SplatFrame[AvatarFrame], *, color: str, depth: str) -> None:
        """`frame` is of this avatar alone; `color` and `depth` are the formats of the target."""
        self._device, self._frame = device, frame
        (self._posed,) = frame.avatars
        self._avatar = avatar = self._posed.avatar.avatar
        self._make_skeleton()
        self._template = _indices(device, avatar.rig.mesh.faces)
        self._mask = device.buffer(MASK_SIZE * MASK_ROW, name="mask")
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
        size = (MASK_SIZE, MASK_SIZE, 1)
        self._mask_texture = device.wgpu.create_texture(size=size, format="r8unorm", usage=usage)
        rest = avatar.rig.skeleton.bind_pose
        self.pose(rest.rotations, rest.translations, ground=0.0)
        opaque: dict[str, Any] = {"depth_write": True, "depth_compare": "less-equal", "blend": False}
        self._draw_surface = _pipeline(device, "surface", "Surface", color, depth, **opaque)
        self._draw_template = _pipeline(device, "template", "Template", color, depth, **opaque)
        self._draw_shadow = _pipeline(device, "shadow", "Shadow", "r8unorm", None, blend=False)
        ground: dict[str, Any] = {"depth_compare": "less-equal", "topology": "triangle-strip", "blend": True}
        self._draw_ground = _pipeline(device, "shadow", "Ground", color, depth, **ground)
        self._draw_stroke = _pipeline(device, "skeleton", "Stroke", color, depth, blend=True)

    @cached_property
    def _surface(self) -> tuple[dict[str, Buffer], _Indices]:
        """The surface's buffers, made when it is first shown."""
        surface = surface_mesh(self._avatar)
        rings = {name: self._device.buffer(getattr(surface, name), name=name) for name in ("ring_starts", "ring")}
        return rings, _indices(self._device, surface.triangles)

    def _make_skeleton(self) -> None:
        skeleton = self._avatar.rig.skeleton
        joints = np.arange(len(skeleton.names), dtype=np.uint32)
        bones = np.flatnonzero(skeleton.parents >= 0)
        strokes = {
            "bones": np.stack([bones, skeleton.parents[bones]], axis=1),
            "dots": np.stack([joints, joints], axis=1),
        }
        self._strokes = {name: self._device.buffer(s.astype(np.uint32), name=name) for name, s in strokes.items()}
        self._stroke_counts = {name: len(s) for name, s in strokes.items()}
        self._joints = self._device.buffer(16 * len(joints), name="joints")

    def pose(
        self,
        rotations: Array,  # [J, 4] local joint rotations
        translations: Array,  # [J, 3] local joint translations, metres
        *,
        ground: float,  # height, metres
    ) -> None:
        """Follow the skeleton; the posed buffers are filled by the frame's own dispatches."""
        skeleton = self._avatar.rig.skeleton
        _, places = skeleton.world(rotations, translations)
        self._joints.write(np.column_stack([places, np.ones(len(places))]).astype(np.float32))
        self._area = shadow_area(self._avatar.bounds + places[skeleton.root], ground)

    def draw_mask(self, encoder: wgpu.GPUCommandEncoder) -> None:
        """Draw the posed template along the light on to the ground, into the mask that `draw_ground` reads."""
        attachment = {
            "view": self._mask_texture.create_view(),
            "load_op": "clear",
            "store_op": "store",
            "clear_value": (0, 0, 0, 0),
        }
        render_pass = encoder.begin_render_pass(color_attachments=[attachment])
        buffers = {"vertex_dq": self._posed.vertex_dq, "mesh": self._posed.mesh}
        self._draw_shadow.bind(render_pass, buffers, light=np.array([*LIGHT, DARKNESS]), area=self._area)
        _draw_indexed(render_pass, self._template)
        render_pass.end()
        encoder.copy_texture_to_buffer(
            {"texture": self._mask_texture},
            {"buffer": self._mask.raw, "bytes_per_row": MASK_ROW, "rows_per_image": MASK_SIZE},
            (MASK_SIZE, MASK_SIZE, 1),
        )

    def draw_ground(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Darken the ground by the mask."""
        constants = {"light": np.array([*LIGHT, DARKNESS]), "area": self._area, "size": MASK_SIZE}
        self._draw_ground.bind(render_pass, {"mask": self._mask}, view_projection=view_projection(camera), **constants)
        render_pass.draw(4)

    def draw_geometry(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw the texel grid as a lit mesh."""
        rings, indices = self._surface
        buffers = {"splats": self._frame.splats, **rings}
        constants = {**_lit(camera, GEOMETRY_COLOR), "first_splat": self._frame.first_splats[0]}
        self._draw_surface.bind(render_pass, buffers, **constants)
        _draw_indexed(render_pass, indices)

    def draw_template(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw the posed coarse mesh, each triangle flat."""
        buffers = {"vertex_dq": self._posed.vertex_dq, "mesh": self._posed.mesh}
        self._draw_template.bind(render_pass, buffers, **_lit(camera, TEMPLATE_COLOR))
        _draw_indexed(render_pass, self._template)

    def draw_skeleton(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw bones and joints over everything else."""
        matrix, screen = view_projection(camera), np.array(camera.screen)
        for name, width, color in (
            ("bones", BONE_WIDTH + 2 * OUTLINE, OUTLINE_COLOR),
            ("bones", BONE_WIDTH, BONE_COLOR),
            ("dots", JOINT_WIDTH + 2 * OUTLINE, OUTLINE_COLOR),
            ("dots", JOINT_WIDTH, JOINT_COLOR),
        ):
            buffers = {"joints": self._joints, "strokes": self._strokes[name]}
            constants = {"color": np.array([*color, 1]), "screen": screen, "width": width}
            self._draw_stroke.bind(render_pass, buffers, view_projection=matrix, **constants)
            render_pass.draw(6 * self._stroke_counts[name])


def ground_height(rig: Rig, clip: Clip | None) -> float:
    """Height of the ground in metres: the lowest point over a clip, except for a few frames, else at rest."""
    if clip is None:
        return float(rig.mesh.vertices[:, 1].min(initial=0))
    frames = np.unique(np.linspace(0, len(clip) - 1, GROUND_FRAMES).astype(int))
    some = clip.cut(frames)
    return float(np.quantile(frame_boxes(rig, some)[:, 0, 1], BELOW_GROUND)) + margin(rig)


def shadow_area(
    bounds: Array,  # [2, 3] what casts the shadow, world, metres
    ground: float,  # height, metres
) -> Array:
    """The square on the ground that holds the shadow of a box: lowest x and z, side, height; metres."""
    corners = np.stack(np.meshgrid(*bounds.T, indexing="ij"), axis=-1).reshape(-1, 3)
    light = np.array(LIGHT)
    places = corners - light * ((corners[:, 1:2] - ground) / light[1])
    low, high = places[:, [0, 2]].min(axis=0), places[:, [0, 2]].max(axis=0)
    side = (high - low).max() * (1 + 2 * MARGIN)
    return np.array([*((low + high - side) / 2), side, ground])


def _pipeline(device: Device, file: str, stem: str, color: str, depth: str | None, **state: Any) -> Pipeline:
    path = SHADERS / f"{file}.hlsl"
    return device.pipeline(path, f"{stem}Vert", f"{stem}Frag", color_format=color, depth_format=depth, **state)


def _lit(camera: Camera, color: tuple[float, float, float]) -> Mapping[str, Any]:
    place = np.array([*camera.position, 1])
    return {"view_projection": view_projection(camera), "camera": place, "color": np.array([*color, 1])}


def _indices(device: Device, triangles: Array) -> _Indices:
    data = triangles.astype(np.uint32).tobytes() or bytes(4)  # an empty buffer cannot be bound
    return device.wgpu.create_buffer_with_data(data=data, usage=wgpu.BufferUsage.INDEX), triangles.size


def _draw_indexed(render_pass: wgpu.GPURenderPassEncoder, indices: _Indices) -> None:
    raw, count = indices
    render_pass.set_index_buffer(raw, "uint32")
    render_pass.draw_indexed(count)
