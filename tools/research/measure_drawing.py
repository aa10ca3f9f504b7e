"""Print how far drawn images are from exact ones, and what leaving out one-sided texels saves.

python tools/research/measure_drawing.py hero.muaavatar --clip walk_07 --frame 280 --pictures build/drawn: one frame
from all sides, as an eye of a headset sees it, by the device at hand. Exact is every Gaussian of every splat integrated
over pixels by 3 x 3 Gauss-Legendre points, in the order of depth. With --share the one-sided texels are measured anew.
"""

# mypy: disable-error-code="index, operator, no-untyped-def, var-annotated"
# Kernels are written in warp's dialect of Python.

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
import warp as wp
from PIL import Image

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.asset.write import write
from mua.avatar.camera import Camera
from mua.avatar.decode import Splats, box_of, decode_clip_frame
from mua.avatar.rendering import to_bytes
from mua.baking.one_sided import shares_behind
from mua.bench.counts import DISTANCES, eye_before, fragments
from mua.gpu import Device, open_device
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import LEAST_OPACITY, eye_ellipses
from mua.player.buffers import AvatarBuffers
from mua.player.draw import EXACT_FORMAT, SplatRenderer, draw_image
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.splatting.tiles import TILE, assign

SIDES = 8
POINTS = 3  # along a side of a pixel
REACH = 4.0  # deviations; beyond, a Gaussian is below 1/2900
MOST_ALPHA = 0.99  # most alpha of one splat at one pixel, as in 3D Gaussian Splatting
BACKGROUNDS = (0.0, 1.0)  # the worse one counts
SHOWN = 0.5  # grey behind images


@wp.func
def pixel_integral(x: float, y: float, quad: int, ellipses: wp.array2d[wp.float32], points: wp.array2d[wp.float32]):
    """Integral of a Gaussian over the pixel whose middle lies at (x, y) from its own."""
    total = wp.float32(0.0)
    for i in range(POINTS):
        for j in range(POINTS):
            u = x + points[i, 0]
            v = y + points[j, 0]
            along = (ellipses[quad, 2] * u + ellipses[quad, 3] * v) / ellipses[quad, 4]
            across = (ellipses[quad, 2] * v - ellipses[quad, 3] * u) / ellipses[quad, 5]
            total += points[i, 1] * points[j, 1] * wp.exp(-0.5 * (along * along + across * across))
    return total


@wp.kernel(enable_backward=False)
def exact_pixels(
    places: wp.array2d[wp.int32],  # [T, 5] of mua.splatting.tiles.Tiles
    starts: wp.array[wp.int32],
    quads: wp.array[wp.int32],
    ellipses: wp.array2d[wp.float32],  # [M, 6] of mua.kernels.splat_project, front to back
    opacities: wp.array[wp.float32],
    colors: wp.array2d[wp.float32],
    points: wp.array2d[wp.float32],  # [POINTS, 2] place along a pixel's side from its middle, weight; these add up to 1
    image: wp.array2d[wp.float32],  # [W H, 4]
):
    tile = wp.tid() // (TILE * TILE)
    inner = wp.tid() % (TILE * TILE)
    column = places[tile, 0] + inner % TILE
    row = places[tile, 1] + inner // TILE
    if column >= places[tile, 2] or row >= places[tile, 3]:
        return
    left = wp.float32(1.0)
    at = row * places[tile, 2] + column
    for pair in range(starts[tile], starts[tile + 1]):
        quad = quads[pair]
        x = float(column) + 0.5 - ellipses[quad, 0]
        y = float(row) + 0.5 - ellipses[quad, 1]
        alpha = wp.min(opacities[quad] * pixel_integral(x, y, quad, ellipses, points), MOST_ALPHA)
        for channel in range(3):
            image[at, channel] += left * alpha * colors[quad, channel]
        left -= left * alpha
    image[at, 3] = 1.0 - left


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--clip", help="the first if left out")
    parser.add_argument("--frame", type=int, help="of the avatar's rate; the middle one if left out")
    parser.add_argument("--distance", type=float, action="append", help="metres; 2.2, 1.0 and 0.6 if left out")
    parser.add_argument("--share", type=float, action="append", default=[], help="24 for 1/24 of a pixel's colour")
    parser.add_argument("--recorded", action="append", default=[], help="clip that --share measures; all if left out")
    parser.add_argument("--pictures", type=Path, help="folder for images: exact, all splats, without one-sided ones")
    given = parser.parse_args()
    torch.set_num_threads(1)
    avatar = read(given.file)
    clip = resample(avatar.clip(given.clip) if given.clip else avatar.clips[0], avatar.encoding.rate)
    frame = len(clip) // 2 if given.frame is None else given.frame
    posed = decode_clip_frame(marked(avatar, None), clip, frame=frame, dtype=np.float64)
    if given.pictures is not None:
        given.pictures.mkdir(parents=True, exist_ok=True)
    device = open_device()
    chosen = markings(avatar, [avatar.clip(name) for name in given.recorded] or avatar.clips, given.share)
    print("| metres | one-sided | least dB | mean dB | million fragments |\n| ---: | --- | ---: | ---: | ---: |")
    for distance in given.distance or DISTANCES:
        cameras = [eye_before(box_of(posed.centres), 2 * np.pi * side / SIDES, distance) for side in range(SIDES)]
        wanted = [exact(posed, camera) for camera in cameras]
        pictures = [[shown(image) for image in wanted]]
        for name, one_sided in chosen.items():
            found = list(drawn(device, marked(avatar, one_sided), clip, frame, cameras))
            losses = [decibels(image, reference) for (image, _), reference in zip(found, wanted, strict=True)]
            counted = np.mean([count for _, count in found]) / 1e6
            figures = f"{min(losses):.2f} | {np.mean(losses):.2f} | {counted:.3f}"
            print(f"| {distance} | {name} | {figures} |", flush=True)
            pictures.append([shown(image) for image, _ in found])
        if given.pictures is not None:
            save(given.pictures, distance, pictures)


def save(folder: Path, distance: float, pictures: list[list[Array]]) -> None:
    """An image for each side: the exact one, then those of each marking, beside each other."""
    for side, images in enumerate(zip(*pictures, strict=True)):
        Image.fromarray(np.hstack(images)).save(folder / f"{distance}_{side}.png")


def markings(avatar: Avatar, clips: Sequence[Clip], shares: Sequence[float]) -> dict[str, Array | None]:
    """One-sided texels [N] by name: none, then those of the file, or those below each share in clips."""
    named: dict[str, Array | None] = {"none": None}
    if shares:
        behind = shares_behind(avatar, clips)
        named |= {f"below 1 of {share:g}, {np.mean(behind < 1 / share):.0%}": behind < 1 / share for share in shares}
    elif (one_sided := avatar.rig.texels.one_sided) is not None:
        named[f"of the file, {np.mean(one_sided):.0%}"] = one_sided
    return named


def marked(avatar: Avatar, one_sided: Array | None) -> Avatar:
    return replace(avatar, rig=replace(avatar.rig, texels=replace(avatar.rig.texels, one_sided=one_sided)))


def exact(splats: Splats, camera: Camera) -> Array:
    """Premultiplied sRGB and alpha [H, W, 4]."""
    covariance = covariances(splats.rotations, splats.scales)
    ellipses = eye_ellipses(splats.centres, covariance, camera.view, camera.projection, camera.screen, camera.near)
    depths = -(splats.centres @ camera.view[2, :3] + camera.view[2, 3])
    order = np.argsort(depths, kind="stable")
    order = order[(ellipses[order, 4] > 0) & (splats.opacities[order] >= LEAST_OPACITY)]
    ellipses = ellipses[order]
    colors = splat_colors(splats.centres[order], splats.texel_dq[order], splats.sh[order], camera.position)
    turns = np.stack([ellipses[:, 2:4], ellipses[:, [3, 2]]], axis=1)  # cosine, sine; sine, cosine
    extent = REACH * np.sqrt((turns**2 @ (ellipses[:, 4:6] ** 2)[..., None])[..., 0]) + 0.5
    tiles = assign(torch.as_tensor(ellipses[:, :2]), torch.as_tensor(extent), camera.screen)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    width, height = camera.screen
    image = wp.zeros((width * height, 4), dtype=wp.float32, device="cpu")
    points = np.stack([nodes / 2, weights / 2], axis=1)
    values = [wp.array(v.astype(np.float32), device="cpu") for v in (ellipses, splats.opacities[order], colors, points)]
    listed = [wp.from_torch(tensor) for tensor in (tiles.places, tiles.starts, tiles.quads)]
    threads = len(tiles.places) * TILE * TILE
    wp.launch(exact_pixels, dim=threads, inputs=[*listed, *values, image], device="cpu")
    return np.asarray(image.numpy().reshape(height, width, 4))


def drawn(
    device: Device, avatar: Avatar, clip: Clip, frame: int, cameras: list[Camera]
) -> Iterator[tuple[Array, float]]:
    """The device's image of a frame for each camera, and its fragments."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "drawn.muaavatar"
        write(path, avatar)
        splats = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, path))])
    renderer = SplatRenderer(device, EXACT_FORMAT)
    window = np.clip(avatar.encoding.frames(frame), 0, len(clip) - 1)
    for camera in cameras:
        commands = device.commands()
        splats.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
        splats.sort(commands, [camera])
        commands.submit()
        image = draw_image(device, renderer, splats.sorted, [camera])
        yield image, float(fragments(device, splats.sorted, camera).sum(dtype=float))


def decibels(found: Array, wanted: Array) -> float:
    """Decibels of the whole image over the worse background."""
    over = [[image[..., :3] + grey * (1 - image[..., 3:]) for image in (found, wanted)] for grey in BACKGROUNDS]
    return float(-10 * np.log10(max(np.mean((one - other) ** 2) for one, other in over)))


def shown(image: Array) -> Array:
    """Over grey."""
    return to_bytes(image[..., :3] + SHOWN * (1 - image[..., 3:]))


if __name__ == "__main__":
    main()
