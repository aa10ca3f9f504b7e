"""The posed template as a camera would see it: what it covers, and how well that fits a mask."""

import numpy as np
from PIL import Image, ImageDraw

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.avatar.camera import NEAR
from mua.capture.camera import CaptureCamera
from mua.pose.clip import Clip
from mua.rig.skinning import Skinning

FINER = 3  # times as fine as pixels triangles are drawn, because drawing widens them by half a step
COVERED = 0.5  # of a mask, from which on a pixel counts as covered
POINTS = 1500  # of a surface that stand for it where many poses are tried
CELLS = 48  # into which the longer side of an image is divided to compare points with masks


def posed_template(surfaces: Surfaces, clip: Clip) -> Array:
    """Vertices [F, V, 3] of a template in the poses of a clip, metres."""
    skinning = Skinning(surfaces.skin_indices, surfaces.skin_weights)
    joints = surfaces.skeleton.skinning(clip.rotations, clip.translations)
    return np.stack([skinning.linear(of_frame, surfaces.vertices) for of_frame in joints])


def pixels(camera: CaptureCamera, points: Array) -> tuple[Array, Array]:
    """Columns and rows [..., 2] of points [..., 3] through the pinhole, and their depths [...], metres."""
    at = points @ camera.world_to_camera[:3, :3].T + camera.world_to_camera[:3, 3]
    depth = at[..., 2]
    places = at[..., :2] / np.maximum(depth, NEAR)[..., None] * camera.focal + camera.centre
    return places, depth


def shown(
    corners: Array,  # [F, 3, 3] metres
    camera: CaptureCamera,
    *,
    facing: float = 0.0,  # least cosine between the normal and the way to the camera
) -> Array:
    """Whether the middle of each triangle is in the image and its front side faces the camera, [F] bool."""
    middles = corners.mean(axis=1)
    places, depth = pixels(camera, middles)
    inside = (depth > 0) & (places >= 0).all(axis=-1) & (places < camera.size).all(axis=-1)
    normals, way = doubled_areas(corners), camera.position - middles
    lengths = np.linalg.norm(normals, axis=-1) * np.linalg.norm(way, axis=-1)
    return np.asarray(inside & (np.sum(normals * way, axis=-1) > facing * lengths))


def doubled_areas(corners: Array) -> Array:
    """Normals [F, 3] of triangles [F, 3, 3], as long as twice their area."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def silhouette(vertices: Array, faces: Array, camera: CaptureCamera) -> Array:
    """Whether the surface with `vertices` [V, 3] and `faces` [F, 3] covers each pixel's middle, [H, W] bool."""
    return fine_silhouette(vertices, faces, camera)[FINER // 2 :: FINER, FINER // 2 :: FINER]


def fine_silhouette(vertices: Array, faces: Array, camera: CaptureCamera) -> Array:
    """Whether the surface covers the middle of every part of a pixel, [FINER H, FINER W] bool."""
    places, depth = pixels(camera, vertices)
    width, height = camera.size
    corners = places[faces[(depth[faces] > NEAR).all(axis=1)]]
    seen = ((corners.max(axis=1) > 0) & (corners.min(axis=1) < camera.size)).all(axis=1)
    picture = Image.new("1", (FINER * width, FINER * height))
    draw = ImageDraw.Draw(picture)
    # One list of numbers: thousands of lists set off garbage collection.
    flat = np.clip(corners[seen] * FINER, -1e5, 1e5).ravel().tolist()
    for first in range(0, len(flat), 6):
        draw.polygon(flat[first : first + 6], fill=1)
    return np.asarray(picture)


def overlap(covered: Array, mask: Array) -> float:
    """Pixels in both over pixels in either, of [H, W] bool; 0 where there are none."""
    either = np.count_nonzero(covered | mask)
    return np.count_nonzero(covered & mask) / either if either else 0.0


def rough_overlap(
    vertices: Array,  # [V, 3] metres
    camera: CaptureCamera,
    mask: Array,  # [H, W] bool
) -> float:
    """Nearly the overlap, a hundred times as fast: of cells that vertices fall into with cells of the mask."""
    places, depth = pixels(camera, vertices[:: max(1, len(vertices) // POINTS)])
    width, height = camera.size
    cell = max(1, max(width, height) // CELLS)
    inside = (depth > 0) & (places >= 0).all(axis=1) & (places < camera.size).all(axis=1)
    masked, covered = (np.zeros((height // cell + 1, width // cell + 1), bool) for _ in range(2))
    row, column = np.nonzero(mask)
    masked[row // cell, column // cell] = True
    column, row = (places[inside] // cell).astype(int).T
    covered[row, column] = True
    return overlap(covered, masked) * float(inside.mean())
