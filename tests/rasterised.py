"""Images of surfaces and bones by numpy alone, which those of the players' shaders are held against.

Each pixel is drawn at its centre and at four places so near to it that rounding decides which of them a device takes.
By as much as these differ an image may be off; where they differ much an edge passes, and the pixel is left out.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import map_coordinates

from mua.arrays import Array
from mua.camera import Camera

NEAR_EDGE = 1 / 64  # pixels: four times what a device that places corners to 1/256 of a pixel may be off
CENTRES = np.array([[0.5, 0.5]]) + NEAR_EDGE * np.array([[0, 0], [-1, -1], [1, -1], [-1, 1], [1, 1]])
STEADY = 0.01  # of a colour: by less an even surface changes between these places
AMBIENT, INSIDE, TURNED = 0.28, 0.45, 0.25  # how surfaces are lit: grazed, from inside, and from where that is sure
BEHIND = 0.01  # metres that surfaces yield to the splats on them
SURFACE_BOUND = 2.0**-11 + 1e-4  # a half float's rounding, in which some images are kept, and float32's of directions
STROKES_BOUND = 2.0**-8 + 4 * 2.0**-11  # corners lie on 1/256 of a pixel; bone and joint, each with its outline, blend
LEAST_STEADY = 0.9  # of what is covered: where edges are many, a tenth lies near one


@dataclass(frozen=True)
class Wall:
    """A plane before the camera, over the left half of the image."""

    distance: float  # metres along the camera's axis


@dataclass(frozen=True)
class Stroke:
    """A line with round ends, or a dot where the ends are one."""

    ends: Array  # [2, 3] world, metres
    color: tuple[float, float, float]  # sRGB
    width: float  # pixels


@dataclass(frozen=True)
class Picture:
    """What should be drawn."""

    image: Array  # [H, W, 4] sRGB, multiplied by the covered share, and that share
    spread: Array  # [H, W] by how much rounding may change it


def compare(found: Array, expected: Picture, bound: float) -> None:
    """Raise AssertionError where a pixel [H, W, 4] differs by more than `bound` and what rounding may do."""
    covered = (expected.image[..., 3] > 0) | (found[..., 3] > 0)
    assert np.mean(covered) > 0.01, "nothing to compare"
    steady = expected.spread < STEADY
    assert np.mean(steady[covered]) > LEAST_STEADY, "an edge in every pixel"
    apart = np.where(steady, np.abs(found - expected.image).max(axis=-1) - expected.spread, 0)
    row, column = np.unravel_index(apart.argmax(), apart.shape)
    assert apart.max() <= bound, (
        f"{np.count_nonzero(apart > bound)} pixels; row {row}, column {column}: "
        f"{found[row, column]}, expected {expected.image[row, column]}"
    )


def smooth(
    camera: Camera, places: Array, triangles: Array, color: Iterable[float], *, wall: Wall | None = None
) -> Picture:
    """A lit surface [T, 3] over places [N, 3]; normals are means of the triangles about a place, weighted by area."""
    a, b, c = (places[triangles[:, corner]] for corner in range(3))
    crossed, normals = np.cross(b - a, c - a), np.zeros_like(places)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], crossed)
    owner, weights = _nearest(camera, places, triangles, wall)
    normal = _between(_unit(normals), triangles[owner], weights)
    facing = np.sum(_unit(normal) * _to_camera(camera, places, triangles[owner], weights), axis=-1)
    dark = 1 + (INSIDE - 1) * np.clip(-facing / TURNED, 0, 1)
    return _picture(owner, dark[..., None] * _light(facing, color))


def flat(
    camera: Camera, places: Array, triangles: Array, color: Iterable[float], *, wall: Wall | None = None
) -> Picture:
    """The same of facets whose two sides are alike."""
    owner, weights = _nearest(camera, places, triangles, wall)
    a, b, c = (places[triangles[owner][..., corner]] for corner in range(3))
    facing = np.sum(_unit(np.cross(b - a, c - a)) * _to_camera(camera, places, triangles[owner], weights), axis=-1)
    return _picture(owner, _light(facing, color))


def strokes(camera: Camera, lines: Iterable[Stroke]) -> Picture:
    """Strokes one over the other, each with an edge that fades over a pixel."""
    at = _samples(camera)[0]
    image = np.zeros((*at.shape[:-1], 4))
    for line in lines:
        (first, last), _ = _project(camera, line.ends)
        along = last - first
        share = np.clip((at - first) @ along / max(along @ along, 1e-12), 0, 1)
        distance = np.linalg.norm(at - first - share[..., None] * along, axis=-1)
        cover = np.clip(line.width / 2 + 0.5 - distance, 0, 1)[..., None]
        image = image * (1 - cover) + cover * np.array([*line.color, 1])
    return Picture(image, np.zeros(image.shape[:2]))


def shadow(
    camera: Camera,
    places: Array,  # [N, 3] metres
    triangles: Array,
    *,
    light: Array,  # [3] the direction along which it falls
    area: Array,  # [4] lowest x and z of a square on the ground, its side, the ground's height; metres
    size: int,  # samples along the square
    darkness: float,
) -> Picture:
    """What a surface takes of the light on the ground: seen or not by each sample, a cubic spline between them."""
    *low, side, ground = area
    fallen = places - light * ((places[:, 1:2] - ground) / light[1])
    corners = (fallen[:, [0, 2]] - low) / side * size
    samples = CENTRES[:, None, None] + np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=-1)
    mask = np.zeros(samples.shape[:3])
    for triangle in corners[triangles]:
        box = _box(triangle)
        mask[box][(_shares(samples[box], triangle) >= 0).all(axis=-1)] = 1
    across, down = np.moveaxis((_on_ground(camera, ground) - low) / side * size - 0.5, -1, 0)
    images = np.zeros((*across.shape, 4))[None].repeat(len(mask), axis=0)
    for image, own in zip(images, mask, strict=True):
        image[..., 3] = darkness * map_coordinates(own, [down, across], order=3, mode="constant", prefilter=False)
    return Picture(images[0], np.abs(images - images[0]).max(axis=(0, -1)))


def _on_ground(camera: Camera, height: float) -> Array:
    """The x and z [H, W, 2] of the ground that each pixel's middle shows; not a number above the horizon."""
    across, down = np.moveaxis(_samples(camera)[0] / camera.screen * [2, -2] + [-1, 1], -1, 0)
    projection = camera.projection
    x, y = (across + projection[0, 2]) / projection[0, 0], (down + projection[1, 2]) / projection[1, 1]
    ray = np.stack([x, y, -np.ones_like(x)], axis=-1) @ camera.view[:3, :3]
    reach = (height - camera.position[1]) / ray[..., 1]
    return np.where(reach > 0, reach, np.nan)[..., None] * ray[..., [0, 2]] + camera.position[[0, 2]]


def _samples(camera: Camera) -> Array:
    """[5, H, W, 2] columns and rows."""
    width, height = camera.screen
    pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1)
    return CENTRES[:, None, None] + pixels


def _project(camera: Camera, points: Array) -> tuple[Array, Array]:
    """Columns and rows [N, 2] of points, and their distances [N] along the camera's axis."""
    eye = points @ camera.view[:3, :3].T + camera.view[:3, 3]
    clip = eye @ camera.projection[:2, :3].T / -eye[:, 2:]
    return (clip * [1, -1] + 1) / 2 * camera.screen, -eye[:, 2]


def _nearest(camera: Camera, places: Array, triangles: Array, wall: Wall | None) -> tuple[Array, Array]:
    """The triangle [5, H, W] that is seen at each sample, -1 for none, and its corners' weights [5, H, W, 3]."""
    at, distance = _project(camera, places)
    away = places - camera.position
    _, yielding = _project(camera, places + BEHIND * _unit(away))
    samples = _samples(camera)
    nearness = np.zeros(samples.shape[:3])  # 1 / distance, which is even over a triangle in the image
    if wall is not None:
        nearness[:, :, : camera.screen[0] // 2] = 1 / wall.distance
    owner, weights = np.full(nearness.shape, -1), np.zeros((*nearness.shape, 3))
    for number, corners in enumerate(triangles):
        box = _box(at[corners])
        share = _shares(samples[box], at[corners])
        near = share @ (1 / yielding[corners])
        seen = (share >= 0).all(axis=-1) & (near >= nearness[box])
        nearness[box][seen] = near[seen]
        owner[box][seen] = number
        weights[box][seen] = share[seen] / distance[corners]  # even in space
    return owner, weights / np.maximum(weights.sum(axis=-1, keepdims=True), 1e-12)


def _box(corners: Array) -> tuple[slice, slice, slice]:
    """Which samples [5, H, W] may lie in a triangle [3, 2]."""
    low = np.floor(corners.min(axis=0) - 1).astype(int).clip(0)
    high = np.ceil(corners.max(axis=0) + 1).astype(int).clip(0)
    return slice(None), slice(low[1], high[1]), slice(low[0], high[0])


def _shares(at: Array, corners: Array) -> Array:
    """Barycentric coordinates [..., 3] of points [..., 2] in a triangle [3, 2]; negative in one that has no area."""
    a, b, c = corners
    area = _cross(b - a, c - a)
    if area == 0:
        return np.full((*at.shape[:-1], 3), -1.0)
    return np.stack([_cross(c - b, at - b), _cross(a - c, at - c), _cross(b - a, at - a)], axis=-1) / area


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def _between(values: Array, corners: Array, weights: Array) -> Array:
    """Values [N, 3] at samples inside triangles [..., 3]."""
    return np.einsum("...k,...ki->...i", weights, values[corners])


def _to_camera(camera: Camera, places: Array, corners: Array, weights: Array) -> Array:
    return _unit(camera.position - _between(places, corners, weights))


def _light(facing: Array, color: Iterable[float]) -> Array:
    """Light from the camera, and a little from everywhere."""
    return (AMBIENT + (1 - AMBIENT) * np.abs(facing))[..., None] * np.array([*color])


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12))


def _picture(owner: Array, color: Array) -> Picture:
    """The image of samples [5, H, W] and their colours [5, H, W, 3]."""
    color = np.concatenate([color, np.ones((*color.shape[:-1], 1))], axis=-1)
    samples = np.where(owner[..., None] >= 0, color, 0)
    return Picture(samples[0], np.abs(samples - samples[0]).max(axis=(0, -1)))
