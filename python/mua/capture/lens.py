"""OpenCV's distortion: where a point that a pinhole would show appears in the image of a real lens."""

import numpy as np

from mua.arrays import Array
from mua.capture.camera import UNDISTORTED, CaptureCamera

ROUNDS = 30  # each leaves about a fifth of the error at the edge of an image that a lens bends by a fifth


def distorted(
    x: Array,  # [...] of points at a distance of 1 before the camera
    y: Array,  # [...]
    coefficients: tuple[float, ...],  # k1, k2, p1, p2, k3
) -> tuple[Array, Array]:
    """The places [...] at which the lens shows them (https://docs.opencv.org/4.x/d9/d0c/group__calib3d.html)."""
    k1, k2, p1, p2, k3 = coefficients
    square = x * x + y * y
    radial = 1 + square * (k1 + square * (k2 + square * k3))
    return (
        x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x),
        y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y,
    )


def undistorted(
    x: Array,  # [...] where the lens shows points at a distance of 1 before the camera
    y: Array,  # [...]
    coefficients: tuple[float, ...],
) -> tuple[Array, Array]:
    """The places [...] at which a pinhole would show them, by fixed-point iteration of `distorted`."""
    if tuple(coefficients) == UNDISTORTED:
        return x, y
    straight = x, y
    for _ in range(ROUNDS):
        bent = distorted(*straight, coefficients)
        straight = straight[0] + x - bent[0], straight[1] + y - bent[1]
    return straight


def lens_pixels(
    camera: CaptureCamera,
    columns: Array,  # [...] pixels of the image without distortion
    rows: Array,  # [...]
) -> tuple[Array, Array]:
    """Columns and rows [...] at which the camera's own image shows them."""
    (fx, fy), (cx, cy) = camera.focal, camera.centre
    x, y = distorted((columns - cx) / fx, (rows - cy) / fy, camera.distortion)
    return fx * x + cx, fy * y + cy


def undistort(
    picture: Array,  # [H, W, C]
    camera: CaptureCamera,
    box: tuple[int, int, int, int],  # left, upper, right, lower
) -> Array:
    """A box of what a pinhole would see, [h, w, C]; 0 where the lens does not reach."""
    left, upper, right, lower = box
    if tuple(camera.distortion) == UNDISTORTED:
        return picture[upper:lower, left:right]
    from scipy.ndimage import map_coordinates  # slow to load, and most captures need none

    rows, columns = np.mgrid[upper:lower, left:right] + 0.5
    at_columns, at_rows = lens_pixels(camera, columns, rows)
    places = np.stack([at_rows, at_columns]) - 0.5  # an array's index is at the pixel's centre
    return np.stack(
        [map_coordinates(channel, places, np.float32, order=1) for channel in np.moveaxis(picture, -1, 0)], axis=-1
    )
