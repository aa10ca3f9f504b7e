"""Posed splats drawn for one or two eyes side by side: by the shaders, and by the reference."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from sorted_keys import append_sort

from mua import rotation
from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.decode import Splats, box_of
from mua.gpu import Device
from mua.kernels.dq_skinning import covariances, pack_splats
from mua.kernels.splat_draw import splat_colors, splat_draw
from mua.kernels.splat_project import splat_project
from mua.kernels.splat_sort import splat_sort
from mua.player.draw import IMAGE_FORMAT, SortedSplats, SplatRenderer, draw_image

PROJECTED = 256  # splats that one group projects
EYE_DISTANCE = 0.063  # metres
EYE_SHIFT = 0.04  # of the projection's axis, towards the nose: eyes of a headset look past their screen's middle


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


def sort_frame(device: Device, frame: Splats, cameras: Sequence[Camera]) -> SortedSplats:
    """The frame's splats projected and sorted by the shaders, as a player does it."""
    covariance = covariances(frame.rotations, frame.scales)
    packed = pack_splats(frame.centres, covariance, frame.opacities, frame.texel_dq, frame.sh)
    count, groups = len(packed), -(-len(packed) // PROJECTED)
    bounds = np.concatenate([frame.bounds, np.ones((2, 1))], axis=1)
    splats = device.buffer(packed, name="splats")
    ellipses = device.buffer(24 * len(cameras) * count, name="ellipses")
    colors = device.buffer(8 * count, name="colors")
    flags, group_counts = device.buffer(4 * count, name="flags"), device.buffer(4 * groups, name="group_counts")
    arguments = device.buffer(32, name="arguments", indirect=True)
    visible, keys = device.buffer(4 * count, name="visible"), device.buffer(4 * count, name="keys")
    commands = device.commands()
    commands.dispatch(
        device.kernel("splat_project.compute", "SplatProject"),
        (groups, 1, 1),
        {"splats": splats, "ellipses": ellipses, "colors": colors, "flags": flags, "group_counts": group_counts},
        view=np.stack([cameras[0].view, cameras[-1].view]),
        projection=np.stack([cameras[0].projection, cameras[-1].projection]),
        camera=np.append(np.mean([camera.position for camera in cameras], axis=0), 1),
        bounds_low=bounds[0],
        bounds_high=bounds[1],
        screen=np.array(cameras[0].screen),
        near=NEAR,
        eyes=len(cameras),
        splat_count=count,
    )
    commands.dispatch(
        device.kernel("splat_project.compute", "ScanCounts"),
        (1, 1, 1),
        {"group_counts": group_counts, "arguments": arguments},
        splat_count=count,
        instances=1,
    )
    commands.dispatch(
        device.kernel("splat_project.compute", "SplatCompact"),
        (groups, 1, 1),
        {"flags": flags, "group_counts": group_counts, "visible": visible, "keys": keys},
        splat_count=count,
    )
    _, order = append_sort(commands, device, keys, visible, arguments)
    commands.submit()
    return SortedSplats(count, splats, ellipses, colors, order, arguments)


def draw_frame(device: Device, frame: Splats, cameras: Sequence[Camera]) -> Array:
    """The shaders' picture [E, H, W, 4], premultiplied."""
    splats = sort_frame(device, frame, cameras)
    image = draw_image(device, SplatRenderer(device, IMAGE_FORMAT), splats, cameras)
    return np.stack(np.split(image, len(cameras), axis=1))


def reference_frame(frame: Splats, cameras: Sequence[Camera]) -> Array:
    """The reference's picture [E, H, W, 4], premultiplied: one order and one colour for both eyes."""
    splats, keys, ellipses = splat_project(
        frame.centres,
        covariances(frame.rotations, frame.scales),
        frame.opacities,
        np.stack([camera.view for camera in cameras]),
        np.stack([camera.projection for camera in cameras]),
        screen=cameras[0].screen,
        near=NEAR,
        bounds=frame.bounds,
    )
    middle = np.mean([camera.position for camera in cameras], axis=0)
    colors = splat_colors(frame.centres[splats], frame.texel_dq[splats], frame.sh[splats], middle)
    order, opacities = splat_sort(keys), frame.opacities[splats]
    return np.stack([splat_draw(e, colors, opacities, order, screen=cameras[0].screen) for e in ellipses])
