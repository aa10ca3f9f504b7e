"""What is drawn of a surface against the exact image: every Gaussian integrated over pixels, in the order of depth.

A window stands for each Gaussian: splats that stand alone differ, those of a surface lie over one another.
"""

import numpy as np
import pytest
from drawn_splats import draw_frame

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import Splats, box_of
from mua.avatar.rendering import render_premultiplied
from mua.channels import SH_C0
from mua.gpu import Device
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import eye_ellipses

RADIUS, COUNT = 0.4, 3000
# Of baked avatars: the deviation of a splat in distances of its neighbours, and the opacity.
SPREAD, OPACITY = 0.65, 0.993
ROOM = 0.88 * np.array([[-1.0, -1, -1], [1, 1, 1]])  # metres; the ball takes a twentieth of an image of it
MOST_ALPHA = 0.99  # the most that one splat covers of a pixel, as in 3D Gaussian Splatting
LEAST_EXACT_PSNR = 45.0  # dB


def exact_picture(frame: Splats, camera: Camera) -> Array:
    """The frame by 8 x 8 Gauss-Legendre points a pixel, all splats to their last pixel, by depth itself; [H, W, 4]."""
    width, height = camera.screen
    nodes, weights = np.polynomial.legendre.leggauss(8)
    x, y = ((np.arange(n)[:, None] + 0.5 + nodes / 2).ravel() for n in (width, height))
    covariance = covariances(frame.rotations, frame.scales)
    ellipses = eye_ellipses(frame.centres, covariance, camera.view, camera.projection, camera.screen, camera.near)
    colors = splat_colors(frame.centres, frame.texel_dq, frame.sh, camera.position)
    depths = -(frame.centres @ camera.view[2, :3] + camera.view[2, 3])
    image = np.zeros((height, width, 4))
    for i in np.argsort(-depths, kind="stable"):
        column, row, cosine, sine, major, minor = ellipses[i]
        if major == 0:
            continue
        span = 6 * major + 1
        rows = slice(*np.clip([int(row - span), int(row + span) + 1], 0, height))
        columns = slice(*np.clip([int(column - span), int(column + span) + 1], 0, width))
        v, u = y[8 * rows.start : 8 * rows.stop, None] - row, x[8 * columns.start : 8 * columns.stop] - column
        density = np.exp(-(((cosine * u + sine * v) / major) ** 2 + ((cosine * v - sine * u) / minor) ** 2) / 2)
        parts = density.reshape(rows.stop - rows.start, 8, columns.stop - columns.start, 8)
        integral = np.einsum("iajb,a,b->ij", parts, weights, weights) / 4
        alpha = np.minimum(frame.opacities[i] * integral, MOST_ALPHA)[..., None]
        image[rows, columns] = image[rows, columns] * (1 - alpha) + alpha * np.append(colors[i], 1)
    return image


def ball() -> Splats:
    """Flat splats on a sphere (Fibonacci lattice) whose colours change from a dozen to the next."""
    i = np.arange(COUNT) + 0.5
    height, angle = 1 - 2 * i / COUNT, np.pi * (1 + np.sqrt(5)) * i
    across = np.sqrt(1 - height**2)
    normals = np.stack([across * np.cos(angle), height, across * np.sin(angle)], axis=1)
    sh = np.zeros((COUNT, 12))
    sh[:, :3] = (0.3 * normals + 0.1 * np.sin(12 * normals[:, [1, 2, 0]])) / SH_C0
    deviation = SPREAD * RADIUS * np.sqrt(4 * np.pi / COUNT)
    return Splats(
        canonical=np.zeros((0, 3)),
        mesh=np.zeros((0, 3)),
        texture=np.zeros((COUNT, 23)),
        centres=RADIUS * normals,
        rotations=rotation.between(np.array([0, 0, 1.0]), normals),
        scales=np.tile([deviation, deviation, deviation / 10], (COUNT, 1)),
        opacities=np.full(COUNT, OPACITY),
        sh=sh,
        texel_dq=np.eye(1, 8).repeat(COUNT, axis=0),
        bounds=box_of(RADIUS * normals),
    )


def psnr(found: Array, exact: Array) -> float:
    """Of premultiplied colour and alpha alike, dB."""
    return float(-10 * np.log10(np.mean(np.square(found - exact))))


@pytest.mark.parametrize("size", [96, 160, 320])
def test_a_surface_is_drawn_near_its_exact_picture(device: Device, size: int) -> None:
    """Splats of 0.5 to 1.7 pixels: from afar, at arm's length and nearer."""
    frame, camera = ball(), orbit(ROOM, screen=(size, size), azimuth=0.7, elevation=0.4)
    exact = exact_picture(frame, camera)
    assert psnr(render_premultiplied(frame, camera), exact) >= LEAST_EXACT_PSNR
    assert psnr(draw_frame(device, frame, [camera])[0], exact) >= LEAST_EXACT_PSNR
