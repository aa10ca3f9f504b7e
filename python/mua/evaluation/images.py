"""Images of a recording's frames by the project's player: one rig, one camera, one mesh, any texture.

The image is square, its background black, its colours display-referred and clipped to 0..1. Cameras stand at equal
angles about the vertical, face the root joint and follow it, at one distance for all frames of a recording.
"""

from collections.abc import Sequence

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.gpu import Device
from mua.player.draw import SplatRenderer, draw_image, image_format
from mua.player.splats import SplatFrame
from mua.player.textured import TexturedRig
from mua.pose.clip import Clip
from mua.recording import WholeFrame
from mua.rig.bounds import frame_boxes, root_positions, union
from mua.rig.rig import Rig

FIRST_VIEW = np.radians(30)  # azimuth in the world, from +Z towards +X
ELEVATION = np.radians(8)


class Studio:
    """Draws textures on the frames of one recording."""

    def __init__(
        self,
        device: Device,
        rig: Rig,
        frames: Sequence[WholeFrame],  # all that will be drawn: they set the distance of the cameras
        *,
        views: int,
        size: int,  # pixels along a side
    ) -> None:
        """Raises InputError where the device has too little memory."""
        self._device, self._rig, self._screen = device, rig, (size, size)
        self.azimuths = [float(FIRST_VIEW + turn) for turn in 2 * np.pi * np.arange(views) / views]
        boxes = [frame_boxes(rig, _still(frame)) - root_positions(rig, _still(frame))[:, None] for frame in frames]
        self._box = union(np.concatenate(boxes))
        self._posed = TexturedRig(device, rig)
        self._frame = SplatFrame(device, [self._posed])
        self._renderer = SplatRenderer(device, image_format(device))

    def cameras(self, frame: WholeFrame) -> list[Camera]:
        """One for each view."""
        (root,) = root_positions(self._rig, _still(frame))
        box = self._box + root
        return [orbit(box, screen=self._screen, azimuth=turn, elevation=float(ELEVATION)) for turn in self.azimuths]

    def draw(
        self,
        frame: WholeFrame,  # whose pose and cameras
        texture: Array,  # [N, 23] raw channels
        *,
        mesh: Array | None = None,  # [V, 3] canonical vertices, metres; the teacher's if left out
    ) -> list[Array]:
        """One image [H, W, 3] float32 in 0..1 for each view."""
        pictures = []
        pose = frame.clip.pose(frame.index)
        for index, camera in enumerate(self.cameras(frame)):
            commands = self._device.commands()
            if index == 0:
                self._posed.pose(commands, frame.mesh if mesh is None else mesh, texture, pose)
            self._frame.sort(commands, [camera])
            commands.submit()
            image = draw_image(self._device, self._renderer, self._frame.sorted, [camera])
            pictures.append(np.clip(image[..., :3], 0, 1))  # premultiplied: over black as it stands
        return pictures


def _still(frame: WholeFrame) -> Clip:
    """The frame as a clip of one."""
    return frame.clip.cut(slice(frame.index, frame.index + 1))
