"""A camera that a mouse orbits, zooms and pans."""

from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import FOV, Camera, near_plane, orbit, perspective

STEEPEST = float(np.radians(89))  # limit of the elevation, so that up stays up
NEAREST, FARTHEST = 0.01, 30.0  # as factors of the distance from which all of the figure is seen
ZOOM_STEP = 1.15  # factor of the distance for one notch of the wheel
TURN = float(np.radians(0.4))  # radians for one pixel of a drag


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """The camera's place about its target."""

    target: Array  # [3] world, metres
    distance: float  # metres
    azimuth: float = 0.0  # radians, as mua.avatar.camera.orbit
    elevation: float = 0.0
    framed: float = 3.5  # metres from which all of the figure is seen; those of a person
    fov: float = FOV  # vertical, radians

    def turned(self, right: float, down: float) -> "Viewpoint":
        """The viewpoint after a drag by this number of pixels: the figure follows the mouse."""
        elevation = np.clip(self.elevation + TURN * down, -STEEPEST, STEEPEST)
        return replace(self, azimuth=self.azimuth - TURN * right, elevation=float(elevation))

    def zoomed(self, notches: float) -> "Viewpoint":
        """The viewpoint nearer by this number of notches of the wheel, farther where negative."""
        distance = np.clip(self.distance * ZOOM_STEP**-notches, NEAREST * self.framed, FARTHEST * self.framed)
        return replace(self, distance=float(distance))

    def nearer(self, times: float) -> "Viewpoint":
        """The viewpoint at a fraction of the distance, so that the middle appears larger by this factor."""
        return self.zoomed(float(np.log(times) / np.log(ZOOM_STEP)))

    def outside(self, reach: float) -> "Viewpoint":
        """The viewpoint at least this number of metres from its target; a longer lens keeps the middle as large."""
        if self.distance >= reach:
            return self
        fov = 2 * np.arctan(np.tan(self.fov / 2) * self.distance / reach)
        return replace(self, distance=reach, fov=float(fov))

    def gone_round(self, angle: float) -> "Viewpoint":
        """Camera and target turned by this angle in radians about the vertical, as when the figure itself turns."""
        c, s = np.cos(angle), np.sin(angle)
        target = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ self.target
        return replace(self, target=target, azimuth=self.azimuth + angle)

    def panned(self, right: float, down: float, *, height: int) -> "Viewpoint":
        """The viewpoint after a panning drag in an image of `height`: the target stays under the mouse."""
        metres = 2 * np.tan(self.fov / 2) * self.distance / height
        across, up, _ = self.camera((height, height)).view[:3, :3]
        return replace(self, target=self.target + metres * (down * up - right * across))

    def camera(self, screen: tuple[int, int]) -> Camera:
        """The camera for a screen of this size in pixels."""
        at = orbit(np.stack([self.target] * 2), screen=screen, azimuth=self.azimuth, elevation=self.elevation)
        view = at.view.copy()
        view[:3, 3] = [0, 0, -self.distance] - view[:3, :3] @ self.target
        projection = perspective(self.fov, aspect=screen[0] / screen[1], near=near_plane(self.distance))
        return replace(at, view=view, projection=projection)


def directions(
    azimuths: Array,  # [N] radians, as mua.avatar.camera.orbit
    elevation: float,
) -> Array:
    """Where a camera is from its target, [N, 3] of length 1."""
    flat = np.cos(elevation)
    return np.stack([flat * np.sin(azimuths), np.full_like(azimuths, np.sin(elevation)), flat * np.cos(azimuths)], -1)


def framing(
    bounds: Array,  # [2, 3] metres
    screen: tuple[int, int],
    *,
    azimuths: Array,  # [N] radians, as mua.avatar.camera.orbit: all from which the box is going to be seen
    elevation: float = 0.0,
) -> Viewpoint:
    """The viewpoint at the first azimuth, at a distance from which all of a box is in the image from each azimuth."""
    target = np.mean(bounds, axis=0)
    places = [orbit(bounds, screen=screen, azimuth=a, elevation=elevation).position for a in np.unique(azimuths)]
    distance = float(np.linalg.norm(np.array(places) - target, axis=-1).max())
    return Viewpoint(target, distance, float(azimuths[0]), elevation, framed=distance)
