"""A pair of shaders that draws triangles or lines from buffers."""

from collections.abc import Mapping
from typing import Any

import wgpu

from mua.gpu.bindings import Bindings, check_names
from mua.gpu.buffer import Buffer
from mua.gpu.constants import Uniforms
from mua.gpu.failure import naming
from mua.gpu.reflect import reflect

OVER = {"src_factor": "one", "dst_factor": "one-minus-src-alpha", "operation": "add"}  # premultiplied colour


class Pipeline:
    """A vertex and a fragment entry; the vertex's resources lie in group 0, the fragment's in group 1."""

    def __init__(
        self,
        device: wgpu.GPUDevice,
        uniforms: Uniforms,
        *,
        vertex: tuple[str, bytes],
        fragment: tuple[str, bytes],
        color_format: str,
        depth_stencil: dict[str, Any] | None,
        blend: bool,
        primitive: dict[str, Any],
    ) -> None:
        """Build from (entry, SPIR-V) of each stage."""
        self.name = f"{vertex[0]} with {fragment[0]}"
        self._uniforms = uniforms
        with naming(f"pipeline {self.name}"):
            stages = ((*vertex, wgpu.ShaderStage.VERTEX), (*fragment, wgpu.ShaderStage.FRAGMENT))
            self.stages = tuple(
                Bindings(device, uniforms, label=f"pipeline {self.name}", interface=reflect(code), stage=stage)
                for _, code, stage in stages
            )
            layout = device.create_pipeline_layout(bind_group_layouts=[stage.layout for stage in self.stages])
            modules = [device.create_shader_module(label=entry, code=code) for entry, code, _ in stages]
            target = {"format": color_format, "blend": {"color": OVER, "alpha": OVER} if blend else None}
            self.raw = device.create_render_pipeline(
                label=self.name,
                layout=layout,
                vertex={"module": modules[0], "entry_point": vertex[0], "buffers": []},
                fragment={"module": modules[1], "entry_point": fragment[0], "targets": [target]},
                primitive=primitive,
                depth_stencil=depth_stencil,
            )

    def bind(self, render_pass: wgpu.GPURenderPassEncoder, buffers: Mapping[str, Buffer], **constants: Any) -> None:
        """Set the pipeline, its buffers and its constants for the draws that follow in this pass."""
        check_names(f"pipeline {self.name}", self.stages, buffers, constants)
        render_pass.set_pipeline(self.raw)
        for index, stage in enumerate(self.stages):
            packed = stage.pack(constants)
            offsets = [] if packed is None else self._uniforms.place([packed])
            render_pass.set_bind_group(index, stage.group(buffers), offsets)
