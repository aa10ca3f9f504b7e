"""Draws sorted splats into a texture, and reads images of them back."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import wgpu

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.gpu import Buffer, Device
from mua.gpu.failure import naming

SHADER = Path(__file__).parent / "shaders" / "splat.hlsl"
IMAGE_FORMAT = "rgba16float"
EXACT_FORMAT = "rgba32float"
CHANNEL_TYPES: dict[str, np.dtype[Any]] = {IMAGE_FORMAT: np.dtype(np.float16), EXACT_FORMAT: np.dtype(np.float32)}
DEVICE_DEPTH = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])  # clip z of -w..w to 0..w


@dataclass(frozen=True)
class SortedSplats:
    """The results of splat_project and splat_sort that the draw reads."""

    splats: Buffer  # [N, 8] words (mua.kernels.splat_project.pack_splats)
    order: Buffer  # [M] the visible splats, back to front
    arguments: Buffer  # [5]; the draw's first
    corners: int  # vertices of a splat, 3 or 6


class SplatRenderer:
    """The pipeline that draws splats into targets of one format."""

    def __init__(
        self, device: Device, color_format: str, *, depth_format: str | None = None, fragment: str = "SplatFrag"
    ) -> None:
        """With a depth format, earlier draws of the pass hide the splats whose centre lies behind them.

        The fragment CountFrag adds 1 to red in place of drawing.
        """
        self.color_format = color_format
        self._pipeline = device.pipeline(
            SHADER,
            "SplatVert",
            fragment,
            color_format=color_format,
            depth_format=depth_format,
            blend=True,
            depth_compare="always" if depth_format is None else "less-equal",
        )

    def draw(self, render_pass: wgpu.GPURenderPassEncoder, splats: SortedSplats, cameras: Sequence[Camera]) -> None:
        """Append the draw of one or two eyes, side by side from the left; all share one size of screen."""
        buffers = {"order": splats.order, "splats": splats.splats}
        for eye, camera in enumerate(cameras):
            set_eye(render_pass, eye, camera)
            self._pipeline.bind(
                render_pass,
                buffers,
                view_projection=view_projection(camera),
                screen=np.array(camera.screen, dtype=np.float32),
                eye=eye,
                corners=splats.corners,
            )
            render_pass.draw_indirect(splats.arguments.raw, 0)


def view_projection(camera: Camera) -> Array:
    """World to clip [4, 4] with the depth range of the device."""
    return np.asarray(DEVICE_DEPTH @ camera.projection @ camera.view)


def set_eye(render_pass: wgpu.GPURenderPassEncoder, eye: int, camera: Camera) -> None:
    """Confine the following draws to this eye's part of the target."""
    width, height = camera.screen
    render_pass.set_viewport(eye * width, 0, width, height, 0, 1)
    render_pass.set_scissor_rect(eye * width, 0, width, height)


def image_format(device: Device) -> str:
    """The best format for adding up many faint splats: half floats lose a part of each where devices truncate."""
    return EXACT_FORMAT if "float32-blendable" in device.wgpu.features else IMAGE_FORMAT


def draw_image(device: Device, renderer: SplatRenderer, splats: SortedSplats, cameras: Sequence[Camera]) -> Array:
    """Premultiplied sRGB and alpha [H, E W, 4] float32 of the eyes side by side.

    The renderer's format is one of CHANNEL_TYPES. Errors: InputError where the device cannot hold so large an image.
    """

    def draw(target: wgpu.GPUTexture) -> None:
        encoder = device.wgpu.create_command_encoder()
        cleared = {"view": target.create_view(), "load_op": "clear", "store_op": "store", "clear_value": (0, 0, 0, 0)}
        render_pass = encoder.begin_render_pass(color_attachments=[cleared])
        renderer.draw(render_pass, splats, cameras)
        render_pass.end()
        device.wgpu.queue.submit([encoder.finish()])

    return image_of(device, renderer.color_format, cameras, draw)


def image_of(
    device: Device, color_format: str, cameras: Sequence[Camera], draw: Callable[[wgpu.GPUTexture], None]
) -> Array:
    """The image [H, E W, 4] float32 that `draw` makes of a texture for all eyes side by side."""
    width, height = cameras[0].screen
    size = (len(cameras) * width, height, 1)
    with naming(f"image of {size[0]} x {size[1]} pixels"):
        usage = wgpu.TextureUsage.RENDER_ATTACHMENT | wgpu.TextureUsage.COPY_SRC
        target = device.wgpu.create_texture(size=size, format=color_format, usage=usage)
        draw(target)
        return read_image(device, target)


def read_image(
    device: Device,
    texture: wgpu.GPUTexture,  # its format is one of CHANNEL_TYPES
) -> Array:
    """The texture's pixels [H, W, 4] float32; waits for the draws."""
    width, height, _ = texture.size
    channel = CHANNEL_TYPES[texture.format]
    row = 4 * channel.itemsize * width
    pixels = device.wgpu.queue.read_texture({"texture": texture}, {"bytes_per_row": row}, texture.size)
    return np.frombuffer(pixels, channel).reshape(height, width, 4).astype(np.float32)
