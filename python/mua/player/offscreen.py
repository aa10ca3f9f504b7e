"""Images without a window, drawn on a device."""

from collections.abc import Sequence

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.gpu import Device
from mua.player.buffers import AvatarBuffers
from mua.player.draw import image_format
from mua.player.frame import AvatarFrame
from mua.player.levels import Levels
from mua.player.overlays import ground_height
from mua.player.scene import Scene, draw_picture
from mua.player.splats import SplatFrame
from mua.player.toggles import Toggles
from mua.pose.clip import Clip


class Offscreen:
    """Draws frames of one clip of an avatar on a device."""

    def __init__(
        self, device: Device, avatar: AvatarBuffers, clip: Clip, toggles: Toggles, *, levels: Levels | None = None
    ) -> None:
        """`clip` is at the rate of the avatar's encoding; `levels` choose the level of detail, else it is the finest.

        Errors: InputError where the device has too little memory.
        """
        self._device, self._clip, self._toggles = device, clip, toggles
        self._frame = SplatFrame(device, [AvatarFrame(device, avatar)])
        (self._avatar,) = self._frame.avatars
        self._scene = Scene(device, self._frame, color_format=image_format(device))
        self._ground = ground_height(avatar.avatar.rig, clip)
        self._levels = levels
        self._decoded: tuple[int, int] | None = None  # frame and level that the splats show

    def picture(
        self,
        index: int,  # frame of the clip
        cameras: Sequence[Camera],  # one eye or two
    ) -> Array:
        """Premultiplied sRGB and alpha [H, E W, 4] of one frame, eyes side by side."""
        window = self._avatar.avatar.avatar.encoding.frames(index)
        rotations, translations = self._clip.rotations[window], self._clip.translations[window]
        level = 0 if self._levels is None else self._levels.choose(rotations[0], translations[0], cameras)
        commands = self._device.commands()
        if (index, level) != self._decoded:
            weights = self._clip.pose(index).expressions
            self._avatar.decode(commands, rotations, translations, level=level, expressions=weights)
            self._scene.pose(rotations[0], translations[0], ground=self._ground)
        self._frame.sort(commands, cameras)
        commands.submit()
        self._decoded = index, level
        return draw_picture(self._device, self._scene, cameras, self._toggles)
