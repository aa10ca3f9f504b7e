"""The layers of an image: background, shadow, geometry or template, splats and skeleton, in this order."""

from collections.abc import Sequence

import wgpu

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.gpu import Device
from mua.player.draw import IMAGE_FORMAT, SplatRenderer, image_of, set_eye
from mua.player.frame import AvatarFrame
from mua.player.overlays import Overlays
from mua.player.splats import SplatFrame
from mua.player.toggles import Toggles

DEPTH_FORMAT = "depth32float"
CLEAR = (0.0, 0.0, 0.0, 0.0)


class Scene:
    """Draws one avatar's decoded and sorted frame into targets of one format."""

    def __init__(
        self,
        device: Device,
        frame: SplatFrame[AvatarFrame],  # splats of this avatar alone
        *,
        color_format: str = IMAGE_FORMAT,
        background: tuple[float, float, float, float] = CLEAR,  # premultiplied sRGB and alpha
    ) -> None:
        self._device, self._background = device, background
        self.color_format = color_format
        self._frame = frame
        self._renderer = SplatRenderer(device, color_format, depth_format=DEPTH_FORMAT)
        self._overlays = Overlays(device, frame, color=color_format, depth=DEPTH_FORMAT)
        self._depth: wgpu.GPUTexture | None = None

    def pose(
        self,
        rotations: Array,  # [J, 4] local joint rotations
        translations: Array,  # [J, 3] local joint translations, metres
        *,
        ground: float,  # height on which the shadow falls, metres
    ) -> None:
        """Move skeleton and shadow to the pose that the frame decodes."""
        self._overlays.pose(rotations, translations, ground=ground)

    def draw(self, target: wgpu.GPUTexture, cameras: Sequence[Camera], toggles: Toggles) -> None:
        """Submit the image of one or two eyes, side by side from the left; the target is as wide as all of them."""
        encoder = self._device.wgpu.create_command_encoder()
        if toggles.shadow:
            self._overlays.draw_mask(encoder)
        color = {
            "view": target.create_view(),
            "load_op": "clear",
            "store_op": "store",
            "clear_value": self._background,
        }
        depth = {
            "view": self._depth_of(target).create_view(),
            "depth_clear_value": 1.0,
            "depth_load_op": "clear",
            "depth_store_op": "discard",
        }
        render_pass = encoder.begin_render_pass(color_attachments=[color], depth_stencil_attachment=depth)
        self._draw_all(render_pass, cameras, toggles)
        render_pass.end()
        self._device.wgpu.queue.submit([encoder.finish()])

    def _draw_all(self, render_pass: wgpu.GPURenderPassEncoder, cameras: Sequence[Camera], toggles: Toggles) -> None:
        """Opaque surfaces and the ground before the splats that blend over them, the skeleton over all."""
        overlays = self._overlays
        draws = [
            (toggles.geometry, overlays.draw_geometry),
            (toggles.template, overlays.draw_template),
            (toggles.shadow, overlays.draw_ground),
        ]
        for eye, camera in enumerate(cameras):
            set_eye(render_pass, eye, camera)
            for shown, draw in draws:
                if shown:
                    draw(render_pass, camera)
        if toggles.splats:
            self._renderer.draw(render_pass, self._frame.sorted, cameras)
        for eye, camera in enumerate(cameras):
            set_eye(render_pass, eye, camera)
            if toggles.skeleton:
                overlays.draw_skeleton(render_pass, camera)

    def _depth_of(self, target: wgpu.GPUTexture) -> wgpu.GPUTexture:
        """The depth texture for a target, kept until the target's size changes."""
        if self._depth is None or self._depth.size != target.size:
            usage = wgpu.TextureUsage.RENDER_ATTACHMENT
            self._depth = self._device.wgpu.create_texture(size=target.size, format=DEPTH_FORMAT, usage=usage)
        return self._depth


def draw_picture(device: Device, scene: Scene, cameras: Sequence[Camera], toggles: Toggles) -> Array:
    """Premultiplied sRGB and alpha [H, E W, 4] float32 of one or two eyes side by side.

    Errors: InputError where the device cannot hold so large an image.
    """
    return image_of(device, scene.color_format, cameras, lambda target: scene.draw(target, cameras, toggles))
