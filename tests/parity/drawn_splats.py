"""Posed splats drawn for one or two eyes side by side: by the shaders, and by the reference."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from projected import texels_of

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera
from mua.avatar.decode import Splats, box_of
from mua.gpu import Device
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors, splat_draw
from mua.kernels.splat_project import splat_project
from mua.kernels.splat_sort import splat_sort
from mua.player.buffers import RigPlaces
from mua.player.draw import IMAGE_FORMAT, SortedSplats, SplatRenderer, draw_image
from mua.player.splats import SplatFrame

EYE_DISTANCE = 0.063  # metres
EYE_SHIFT = 0.04  # the projection's axis moves towards the nose, as a headset's eyes look past their screen's middle


def stereo(camera: Camera) -> tuple[Camera, Camera]:
    """A left and a right eye about the camera."""
    left, right = (np.eye(4), np.eye(4))
    left[0, 3], right[0, 3] = EYE_DISTANCE / 2, -EYE_DISTANCE / 2
    skews = [camera.projection.copy() for _ in range(2)]
    skews[0][0, 2], skews[1][0, 2] = EYE_SHIFT, -EYE_SHIFT
    return (
        replace(camera, view=left @ camera.view, projection=skews[0]),
        replace(camera, view=right @ camera.view, projection=skews[1]),
    )


def random_frame(count: int, bounds: Array, *, deviations: tuple[float, float], seed: int = 0) -> Splats:
    """Splats in and around the bounds, from the least to the largest of `deviations` in metres, half of them faint."""
    rng = np.random.default_rng(seed)
    middle, half = bounds.mean(axis=0), np.ptp(bounds, axis=0) / 2
    least, largest = np.log(deviations)
    size = np.exp(rng.uniform(least, largest, (count, 1)))
    turns = rotation.normalize(rng.normal(size=(count, 4)))
    centres = middle + half * rng.uniform(-1.2, 1.2, (count, 3))
    return Splats(
        canonical=np.zeros((0, 3)),
        mesh=np.zeros((0, 3)),
        texture=np.zeros((0, 23)),
        centres=centres,
        rotations=rotation.normalize(rng.normal(size=(count, 4))),
        scales=size * np.exp(rng.uniform(-1, 0, (count, 3))),
        opacities=np.where(rng.random(count) < 0.5, rng.uniform(0, 0.3, count), rng.uniform(0.3, 0.999, count)),
        sh=0.4 * rng.normal(size=(count, 12)),
        texel_dq=np.concatenate([turns, np.zeros((count, 4))], axis=1),
        bounds=box_of(centres),
    )


class PosedFrame:
    """A frame's splats as a posed avatar, each on a vertex of its own."""

    def __init__(self, device: Device, frame: Splats) -> None:
        texels = texels_of(frame)
        buffers = {name: device.buffer(array, name=name) for name, array in texels.buffers.items()}
        self.rig = RigPlaces(buffers["faces"], buffers["texels"])
        self.mesh, self.vertex_dq = buffers["mesh"], buffers["vertex_dq"]
        self.texel_channels = buffers["texel_channels"]
        self.splat_count, self.bounds = len(texels), frame.bounds


def as_drawn(frame: Splats) -> Splats:
    """The frame as the kernels are given it, in half floats; its box stays."""
    return replace(texels_of(frame).splats, bounds=frame.bounds)


def sort_frame(device: Device, frame: Splats, cameras: Sequence[Camera]) -> SortedSplats:
    """The frame's splats projected and sorted by the shaders, as a player does it."""
    splats = SplatFrame(device, [PosedFrame(device, frame)])
    commands = device.commands()
    splats.sort(commands, cameras)
    commands.submit()
    return splats.sorted


def draw_frame(device: Device, frame: Splats, cameras: Sequence[Camera]) -> Array:
    """The shaders' image [E, H, W, 4], premultiplied."""
    splats = sort_frame(device, frame, cameras)
    image = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, cameras)
    return np.stack(np.split(image, len(cameras), axis=1))


def reference_frame(frame: Splats, cameras: Sequence[Camera]) -> Array:
    """The reference's image [E, H, W, 4], premultiplied: one order for both eyes."""
    frame = as_drawn(frame)
    splats, keys, ellipses = splat_project(
        frame.centres,
        covariances(frame.rotations, frame.scales),
        frame.opacities,
        np.stack([camera.view for camera in cameras]),
        np.stack([camera.projection for camera in cameras]),
        screen=cameras[0].screen,
        near=NEAR,
        bounds=frame.bounds,
        normals=frame.normals,
    )
    on_screen = frame.centres[splats], frame.texel_dq[splats], frame.sh[splats]
    colors = [splat_colors(*on_screen, camera.position) for camera in cameras]
    order, opacities = splat_sort(keys), frame.opacities[splats]
    drawn = zip(ellipses, colors, strict=True)
    return np.stack([splat_draw(e, c, opacities, order, screen=cameras[0].screen) for e, c in drawn])
