"""A pinhole camera and the orbit view that frames an avatar.

Eye space is right-handed, Y up, looking along -Z (as in glTF); matrices act on column vectors.
"""

from dataclasses import dataclass, replace

import numpy as np

from mua.arrays import Array

NEAR = 0.02  # metres, at most
NEAR_SHARE = 0.01  # share of the distance to the subject, so that a small figure is not clipped
FOV = float(np.radians(30))  # vertical; a portrait lens
EYE_DISTANCE = 0.063  # metres, for an adult
FILL = 0.92  # share of the image's half size that the framed box fills


@dataclass(frozen=True, eq=False)
class Camera:
    """The camera of one eye."""

    view: Array  # [4, 4] world to eye, metres
    projection: Array  # [4, 4] eye to clip
    screen: tuple[int, int]  # width, height, pixels

    @property
    def position(self) -> Array:
        """[3] world, metres."""
        return np.asarray(-self.view[:3, :3].T @ self.view[:3, 3])

    @property
    def near(self) -> float:
        """Distance of the near plane, metres."""
        return float(self.projection[2, 3]) / -2

    def pixels(
        self,
        points: Array,  # [N, 3] world, metres
    ) -> tuple[Array, Array]:
        """Columns and rows [N, 2] of points in the image, and their depths [N] before the eye, metres."""
        clip = np.column_stack([points, np.ones(len(points))]) @ (self.projection @ self.view).T
        return (clip[:, :2] / clip[:, 3:] * [1, -1] + 1) / 2 * self.screen, clip[:, 3]


def perspective(
    fov: float,  # vertical, radians
    *,
    aspect: float,  # width / height
    near: float = NEAR,  # metres
) -> Array:
    """Projection matrix [4, 4] with the far plane at infinity, clip z in -w..w."""
    focal = 1 / np.tan(fov / 2)
    matrix = np.diag([focal / aspect, focal, -1.0, 0.0])
    matrix[2, 3], matrix[3, 2] = -2 * near, -1
    return matrix


def orbit(
    bounds: Array,  # [2, 3] lowest and highest corner of what to frame, metres
    *,
    screen: tuple[int, int],  # width, height, pixels
    azimuth: float = 0.0,  # radians; 0 faces the character (from +Z), positive goes round to its left (+X)
    elevation: float = 0.0,  # radians; positive looks down
    fov: float = FOV,  # vertical, radians
) -> Camera:
    """A camera that looks at the middle of the box, from the nearest distance at which all of it is in the image."""
    projection = perspective(fov, aspect=screen[0] / screen[1])
    turn = _pitch(elevation) @ _yaw(-azimuth)
    middle = np.mean(bounds, axis=0)
    corners = np.array(np.meshgrid(*np.transpose(bounds - middle))).reshape(3, -1)
    x, y, z = turn @ corners
    slope_x, slope_y = FILL / projection[0, 0], FILL / projection[1, 1]
    distance = float(np.max(z + np.maximum(np.abs(x) / slope_x, np.abs(y) / slope_y))) or NEAR
    view = np.eye(4)
    view[:3, :3] = turn
    view[:3, 3] = [0, 0, -distance] - turn @ middle
    return Camera(view, perspective(fov, aspect=screen[0] / screen[1], near=near_plane(distance)), screen)


def sees(
    camera: Camera,
    box: Array,  # [2, 3] lowest and highest corner, metres
) -> bool:
    """Whether the box may be in the image: false where all of it lies beyond one side or before the near plane."""
    corners = np.array(np.meshgrid(*np.transpose(box))).reshape(3, -1)
    x, y, z, w = camera.projection @ camera.view @ np.concatenate([corners, np.ones((1, corners.shape[1]))])
    return not any(side.all() for side in (x > w, x < -w, y > w, y < -w, z < -w))


def near_plane(distance: float) -> float:
    """Distance in metres of the near plane of a camera that looks at a subject at this distance."""
    return min(NEAR, NEAR_SHARE * distance)


def stereo(
    camera: Camera,
    distance: float,  # between the eyes, metres
) -> tuple[Camera, Camera]:
    """A left and a right eye that look the same way, with the camera midway between them."""
    left, right = camera.view.copy(), camera.view.copy()
    left[0, 3] += distance / 2
    right[0, 3] -= distance / 2
    return replace(camera, view=left), replace(camera, view=right)


def _yaw(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def _pitch(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
