"""What a viewer shows beside the splats: detailed geometry, template, skeleton and cast shadow (paper, section System)."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import wgpu

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.camera import Camera
from mua.gpu import Buffer, Device
from mua.gpu.draw import Pipeline
from mua.player.surface import build_surface, rings

SHADERS = Path(__file__).parent / "shaders"
GEOMETRY_COLOR = (0.80, 0.78, 0.75)  # sRGB
TEMPLATE_COLOR = (0.62, 0.72, 0.84)
BONE_COLOR = (0.98, 0.62, 0.12)
JOINT_COLOR = (1.0, 0.97, 0.90)
OUTLINE_COLOR = (0.12, 0.10, 0.08)
BONE_WIDTH, JOINT_WIDTH, OUTLINE = 3.0, 7.0, 2.0  # pixels; an outline shows on any background

LIGHT = (-0.35, -1.0, -0.45)  # from above, the character's left and front: the shadow falls behind it
DARKNESS = 0.45  # of the ground in full shadow
MASK_SIZE = 512  # samples along the shadow's square
MARGIN = 0.1  # metres round the shadow, so that its soft edge is not cut off


@dataclass(frozen=True)
class PosedBuffers:
    """What the overlays read of a frame."""

    splats: Buffer  # uint4 [4 N]
    vertex_dq: Buffer  # float4 [2 V]
    mesh: Buffer  # float [3 V] canonical


class Overlays:
    """Draws around the splats of one avatar."""

    def __init__(self, device: Device, avatar: Avatar, posed: PosedBuffers, *, color: str, depth: str) -> None:
        """`color` and `depth` are the formats of the target."""
        self._device, self._avatar, self._posed = device, avatar, posed
        self._make_geometry()
        self._make_skeleton()
        opaque: dict[str, Any] = {"depth_write": True, "depth_compare": "less-equal", "blend": False}
        self._surface = _pipeline(device, "surface", "Surface", color, depth, **opaque)
        self._template = _pipeline(device, "template", "Template", color, depth, **opaque)
        self._shadow = _pipeline(device, "shadow", "Shadow", "r8unorm", None, blend=False)
        ground: dict[str, Any] = {"depth_compare": "less-equal", "topology": "triangle-strip", "blend": True}
        self._ground = _pipeline(device, "shadow", "Ground", color, depth, **ground)
        self._stroke = _pipeline(device, "skeleton", "Stroke", color, depth, blend=True)

    def _make_geometry(self) -> None:
        rig = self._avatar.rig
        surface = build_surface(rig.mesh, rig.texels)
        template = rings(rig.mesh.faces.astype(np.int64), len(rig.mesh.vertices))
        self._surface_rings = self._upload_rings(surface.ring_starts, surface.ring, "surface")
        self._template_rings = self._upload_rings(template.ring_starts, template.ring, "template")
        self._surface_indices = self._index_buffer(surface.triangles)
        self._template_indices = self._index_buffer(template.triangles)
        self._mask = self._device.buffer(MASK_SIZE * MASK_SIZE, name="mask")
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
        self._mask_texture = self._device.wgpu.create_texture(
            size=(MASK_SIZE, MASK_SIZE, 1), format="r8unorm", usage=usage
        )

    def _make_skeleton(self) -> None:
        skeleton = self._avatar.rig.skeleton
        joints = np.arange(len(skeleton.names), dtype=np.uint32)
        bones = np.flatnonzero(skeleton.parents >= 0)
        strokes = {"bones": np.stack([bones, skeleton.parents[bones]], axis=1), "dots": np.stack([joints, joints], axis=1)}
        self._strokes = {name: self._device.buffer(s.astype(np.uint32), name=name) for name, s in strokes.items()}
        self._stroke_counts = {name: len(s) for name, s in strokes.items()}
        self._joints = self._device.buffer(16 * len(joints), name="joints")

    def _upload_rings(self, starts: Array, ring: Array, name: str) -> dict[str, Buffer]:
        return {
            "ring_starts": self._device.buffer(starts, name=f"{name} ring starts"),
            "ring": self._device.buffer(ring, name=f"{name} ring"),
        }

    def _index_buffer(self, triangles: Array) -> tuple[wgpu.GPUBuffer, int]:
        """Indices on the device and how many there are; never an empty buffer, which cannot be bound."""
        data = triangles.astype(np.uint32).tobytes() or bytes(4)
        raw = self._device.wgpu.create_buffer_with_data(data=data, usage=wgpu.BufferUsage.INDEX)
        return raw, triangles.size

    def pose(
        self,
        rotations: Array,  # [J, 4] local joint rotations
        translation: Array,  # [3] local translation of the root joint, metres
        *,
        ground: float,  # height, metres
    ) -> None:
        """Follow the skeleton; the posed buffers are filled by the frame's own dispatches."""
        skeleton = self._avatar.rig.skeleton
        _, places = skeleton.world(rotations, translation)
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
        self._shadow.bind(render_pass, buffers, light=np.array([*LIGHT, DARKNESS]), area=self._area)
        _draw_indexed(render_pass, self._template_indices)
        render_pass.end()
        encoder.copy_texture_to_buffer(
            {"texture": self._mask_texture},
            {"buffer": self._mask.raw, "bytes_per_row": MASK_SIZE, "rows_per_image": MASK_SIZE},
            (MASK_SIZE, MASK_SIZE, 1),
        )

    def draw_ground(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Darken the ground by the mask."""
        constants = {"light": np.array([*LIGHT, DARKNESS]), "area": self._area, "size": MASK_SIZE}
        self._ground.bind(render_pass, {"mask": self._mask}, view_projection=view_projection(camera), **constants)
        render_pass.draw(4)

    def draw_geometry(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw the texel grid as a lit mesh."""
        buffers = {"splats": self._posed.splats, **self._surface_rings}
        self._surface.bind(render_pass, buffers, **_lit(camera, GEOMETRY_COLOR))
        _draw_indexed(render_pass, self._surface_indices)

    def draw_template(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw the posed coarse mesh, lit."""
        buffers = {"vertex_dq": self._posed.vertex_dq, "mesh": self._posed.mesh, **self._template_rings}
        self._template.bind(render_pass, buffers, **_lit(camera, TEMPLATE_COLOR))
        _draw_indexed(render_pass, self._template_indices)

    def draw_skeleton(self, render_pass: wgpu.GPURenderPassEncoder, camera: Camera) -> None:
        """Draw bones and joints over all that is there."""
        matrix, screen = view_projection(camera), np.array(camera.screen)
        for name, width, color in (
            ("bones", BONE_WIDTH + 2 * OUTLINE, OUTLINE_COLOR),
            ("bones", BONE_WIDTH, BONE_COLOR),
            ("dots", JOINT_WIDTH + 2 * OUTLINE, OUTLINE_COLOR),
            ("dots", JOINT_WIDTH, JOINT_COLOR),
        ):
            buffers = {"joints": self._joints, "strokes": self._strokes[name]}
            constants = {"color": np.array([*color, 1]), "screen": screen, "width": width}
            self._stroke.bind(render_pass, buffers, view_projection=matrix, **constants)
            render_pass.draw(6 * self._stroke_counts[name])


def shadow_area(
    bounds: Array,  # [2, 3] what casts the shadow, world, metres
    ground: float,  # height, metres
) -> Array:
    """The square on the ground that holds the shadow of a box: lowest x and z, side, height; metres."""
    corners = np.stack(np.meshgrid(*bounds.T, indexing="ij"), axis=-1).reshape(-1, 3)
    light = np.array(LIGHT)
    places = corners - light * ((corners[:, 1:2] - ground) / light[1])
    low, high = places[:, [0, 2]].min(axis=0), places[:, [0, 2]].max(axis=0)
    side = (high - low).max() + 2 * MARGIN
    return np.array([*((low + high - side) / 2), side, ground])


def view_projection(camera: Camera) -> Array:
    """World to clip [4, 4] with depth in 0..w as the device wants it; the camera's own is in -w..w."""
    depth = np.eye(4)
    depth[2, 2:] = 0.5
    return depth @ camera.projection @ camera.view


def _pipeline(device: Device, file: str, stem: str, color: str, depth: str | None, **state: Any) -> Pipeline:
    path = SHADERS / f"{file}.hlsl"
    return device.pipeline(path, f"{stem}Vert", f"{stem}Frag", color_format=color, depth_format=depth, **state)


def _lit(camera: Camera, color: tuple[float, float, float]) -> Mapping[str, Any]:
    place = np.array([*camera.position, 1])
    return {"view_projection": view_projection(camera), "camera": place, "color": np.array([*color, 1])}


def _draw_indexed(render_pass: wgpu.GPURenderPassEncoder, indices: tuple[wgpu.GPUBuffer, int]) -> None:
    raw, count = indices
    render_pass.set_index_buffer(raw, "uint32")
    render_pass.draw_indexed(count)
