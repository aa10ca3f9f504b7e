"""Draws on a device what the stand-ins recorded of the Unity package's draws, by the very programs of its shaders."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import wgpu
from csharp import RUNTIME
from replay import Drawn, value
from shader_programs import VARIANTS, Program, programs

from mua.arrays import Array
from mua.gpu import Device
from mua.gpu.draw import Pipeline
from mua.player.draw import image_format, read_image

DEPTH_FORMAT = "depth32float"
GAMMA = ("UNITY_COLORSPACE_GAMMA",)
UNITY_TESTS = {"LEqual": "greater-equal", "Always": "always"}  # the device's depth runs from 1 to 0
UNITY_BLENDS = {"One OneMinusSrcAlpha": True, "Off": False}
PLANE = """
cbuffer Constants { float depth; };
float4 PlaneVert(uint vertex : SV_VertexID) : SV_Position
{
    return float4(vertex == 1 ? 3 : -1, vertex == 2 ? 3 : -1, depth, 1);
}
float4 PlaneFrag() : SV_Target { return 0; }
"""


@dataclass(frozen=True)
class Target:
    """A texture with depth that is cleared to what is farthest."""

    device: Device
    color_format: str
    size: tuple[int, int]  # width, height
    farthest: float
    planes: Path  # a folder for the shader of planes

    def image(self, draw: Any, plane: tuple[float, tuple[int, int, int, int]] | None = None) -> Array:
        """[H, W, 4] of what `draw(render_pass)` adds; first a depth in a rectangle (x, y, width, height)."""
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
        create, size = self.device.wgpu.create_texture, (*self.size, 1)
        color = create(size=size, format=self.color_format, usage=usage)
        depth = create(size=size, format=DEPTH_FORMAT, usage=wgpu.TextureUsage.RENDER_ATTACHMENT)
        encoder = self.device.wgpu.create_command_encoder()
        render_pass = encoder.begin_render_pass(
            color_attachments=[
                {"view": color.create_view(), "load_op": "clear", "store_op": "store", "clear_value": (0, 0, 0, 0)}
            ],
            depth_stencil_attachment={
                "view": depth.create_view(),
                "depth_load_op": "clear",
                "depth_store_op": "store",
                "depth_clear_value": self.farthest,
            },
        )
        if plane is not None:
            self._lay(render_pass, *plane)
            render_pass.set_scissor_rect(0, 0, *self.size)
        draw(render_pass)
        render_pass.end()
        self.device.wgpu.queue.submit([encoder.finish()])
        return read_image(self.device, color)

    def _lay(self, render_pass: wgpu.GPURenderPassEncoder, depth: float, where: tuple[int, int, int, int]) -> None:
        path = self.planes / "plane.hlsl"
        path.write_text(PLANE)
        pipeline = self.device.pipeline(
            path,
            "PlaneVert",
            "PlaneFrag",
            color_format=self.color_format,
            depth_format=DEPTH_FORMAT,
            blend=False,
            depth_write=True,
        )
        pipeline.bind(render_pass, {}, depth=depth)
        render_pass.set_scissor_rect(*where)
        render_pass.draw(3)


class UnityDraw:
    """One recorded draw with one variant of its program."""

    def __init__(
        self, device: Device, drawn: Drawn, program: Program, folder: Path, defines: tuple[str, ...], color_format: str
    ) -> None:
        assert (drawn.shader, drawn.pass_index) == (program.shader, program.index)
        self._label, self._arguments, self._drawn = str(program), drawn.arguments, drawn
        self._pipeline: Pipeline = device.pipeline(
            program.write(folder, *defines, "REPLAYED"),
            program.vertex,
            program.fragment,
            color_format=color_format,
            depth_format=DEPTH_FORMAT,
            blend=UNITY_BLENDS[program.state["Blend"]],
            depth_write={"On": True, "Off": False}[program.state["ZWrite"]],
            depth_compare=UNITY_TESTS[program.state["ZTest"]],
            cull={"Off": "none", "Back": "back"}[program.state["Cull"]],
        )
        slots = {slot.name: slot for stage in self._pipeline.stages for slot in stage.buffers}
        assert slots.keys() <= drawn.buffers.keys(), f"{program}: a buffer was never set"
        for name, slot in slots.items():
            assert drawn.strides[name] == slot.stride, f"{program}: {name} has stride {drawn.strides[name]}"
        self._buffers = {name: device.buffer(drawn.buffers[name], name=name) for name in slots}
        self._indices = None
        if drawn.indices is not None:
            usage = wgpu.BufferUsage.INDEX
            self._indices = device.wgpu.create_buffer_with_data(data=drawn.indices.tobytes(), usage=usage)

    def draw(self, render_pass: wgpu.GPURenderPassEncoder, **engine: Any) -> None:
        """Append the draw, with what the engine would set for its shaders."""
        constants = {name: c for stage in self._pipeline.stages for name, c in stage.constants.items()}
        bound = {name: given for name, given in engine.items() if name in constants}
        for name in constants.keys() - bound.keys() & self._drawn.constants.keys():
            bound[name] = value(self._label, constants[name], *self._drawn.constants[name])
        self._pipeline.bind(render_pass, self._buffers, **bound)
        if self._indices is None:
            render_pass.draw(*self._arguments)
        else:
            render_pass.set_index_buffer(self._indices, "uint32")
            render_pass.draw_indexed(*self._arguments)


def rows(*, turned: bool) -> dict[str, Array]:
    """The engine's projections for a target that it turns upside down, or not; of their other values none is read."""
    projection = np.diag([1.7, -2.3 if turned else 2.3, 0, 0])
    return {"glstate_matrix_projection": projection, "unity_StereoMatrixP": np.stack([projection, projection])}


class UnityPainter:
    """Draws the passes of a shader of the package as Unity would."""

    def __init__(self, device: Device, folder: Path, shader: str, size: tuple[int, int]) -> None:
        self.device, self.folder, self.size, self.format = device, folder, size, image_format(device)
        self.passes = {program.index: program for program in programs(RUNTIME / "Shaders" / shader)}

    def unity(
        self,
        drawn: Drawn,
        *,
        variant: str = "mono",
        space: tuple[str, ...] = GAMMA,
        turned: bool = False,
        plane: float | None = None,  # depth on the device, over the left half of the target
        **engine: Any,
    ) -> Array:
        """[H, W, 4] of one eye, rows as the target stores them."""
        defines = (*VARIANTS[variant], *space)
        draw = UnityDraw(self.device, drawn, self.passes[drawn.pass_index], self.folder, defines, self.format)
        target = Target(self.device, self.format, self.size, 0.0, self.folder)
        half = None if plane is None else (plane, (0, 0, self.size[0] // 2, self.size[1]))
        given = {"unity_StereoEyeIndex": 0, **rows(turned=turned), **engine}
        return target.image(lambda render_pass: draw.draw(render_pass, **given), half)
