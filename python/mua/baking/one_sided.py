"""Which texels are one-sided: hidden by others wherever a camera sees their triangles from behind.

That is measured on images of an avatar's most different poses, from all around: a texel is one-sided that nowhere
gives a pixel LARGEST_SHARE or more of its colour while splat_project would leave it out. None is that lies near an open
edge of the mesh: tips of hair and hems are thin, and a pose that was not looked at shows them from within.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

import numpy as np
import torch
from scipy.spatial import cKDTree
from trimesh.grouping import group_rows, unique_rows

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.coarser import texel_length
from mua.avatar.decode import Splats, box_of, decode_clip_frame, texel_normals
from mua.avatar.model import Model
from mua.kernels.splat_project import AWAY, facing
from mua.pose.clip import Clip
from mua.pose.resample import frames_at
from mua.rig.rig import Rig
from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import largest_shares
from mua.training.threads import in_order
from mua.training.torch_threads import few_threads, thread_share

LARGEST_SHARE = 1 / 24  # as a part of a pixel's colour
OPEN = 0.01  # times the figure's largest side: texels so near to an open edge are not one-sided
SAME_PLACE = 1e-6  # times the same side: vertices so near to each other are one, as along the seams of a texture
POSES, VIEWS = 8, 24  # views of each pose
PIXEL = 1.0  # texels, in the middle of an image
FOV = np.radians(60)  # the images': near enough for openings to be looked into
LARGEST_SIDE = 4096  # pixels
SAME = 1e-9  # squared sines, summed over joints, of poses that are one
LOOKED_AT = 512  # frames, evenly over all clips, among which poses are chosen
EDGE_POINTS = 9  # along an open edge, from which distances are taken
GOLDEN = np.pi * (3 - np.sqrt(5))  # radians

M = TypeVar("M", bound=Model)


def with_one_sided(
    avatar: M,
    clips: Sequence[Clip],
    *,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> M:
    """The avatar with its one-sided texels marked, in the poses of clips; as it was where there are none."""
    if not clips:
        return avatar
    one_sided = (shares_behind(avatar, clips, progress=progress) < LARGEST_SHARE) & ~near_open_edges(avatar.rig)
    texels = replace(avatar.rig.texels, one_sided=one_sided)
    return replace(avatar, rig=replace(avatar.rig, texels=texels))


def shares_behind(
    avatar: Model,
    clips: Sequence[Clip],
    *,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Array:
    """The largest share of a pixel that each texel gives, [N], wherever splat_project may leave it out."""
    texels = replace(avatar.rig.texels, one_sided=None)
    whole = replace(avatar, rig=replace(avatar.rig, texels=texels))
    behind = np.zeros(len(texels.texels))
    poses = distinct_poses(clips, avatar.encoding.rate, root=avatar.rig.skeleton.root)
    threads = few_threads()
    with thread_share(threads):
        for number, (clip, frame) in enumerate(poses):
            splats = decode_clip_frame(whole, clip, frame=frame)
            normals = texel_normals(whole.rig, splats.canonical, splats.texel_dq)
            cameras = around(splats, texel_length(whole), first=number * VIEWS)
            drawn, bounds = TorchSplats.of(splats), torch.as_tensor(splats.bounds)
            for shares in in_order(partial(_shares_behind, drawn, bounds, normals), cameras, threads=threads):
                np.maximum(behind, shares, out=behind)
            progress(number + 1, len(poses))
    return behind


def open_edges(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Array:
    """The edges [n, 2] that only one triangle has; vertices at one place count as one."""
    size = float(np.ptp(vertices, axis=0).max())
    _, welded = unique_rows(np.round(vertices / (SAME_PLACE * size)).astype(np.int64))
    edges = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    return np.asarray(edges[group_rows(np.sort(welded[edges], axis=1), require_count=1)])


def near_open_edges(rig: Rig) -> Array:
    """Whether each texel [N] lies near an edge that only one triangle has."""
    vertices, faces, texels = rig.mesh.vertices, rig.mesh.faces, rig.texels
    size = float(np.ptp(vertices, axis=0).max())
    ends = vertices[open_edges(vertices, faces)]
    if not len(ends):
        return np.zeros(len(texels.texels), bool)
    steps = np.linspace(0, 1, EDGE_POINTS)[:, None, None]
    along = ((1 - steps) * ends[:, 0] + steps * ends[:, 1]).reshape(-1, 3)
    places = np.einsum("ni,nix->nx", texels.barycentrics, vertices[faces[texels.triangles]])
    return np.asarray(cKDTree(along).query(places, distance_upper_bound=OPEN * size)[0] < OPEN * size)


def distinct_poses(
    clips: Sequence[Clip],
    rate: float,  # frames per second of the frames that are returned
    *,
    root: int,  # joint whose rotation does not count
) -> list[tuple[Clip, int]]:
    """Up to POSES frames of clips: the first, then always that which is farthest from all chosen ones."""
    owners = [(clip, frame) for clip in clips for frame in range(frames_at(clip, rate))]
    owners = owners[:: -(-len(owners) // LOOKED_AT) or 1]
    turns = [clip.rotations[min(round(frame * clip.rate / rate), len(clip) - 1)] for clip, frame in owners]
    apart = np.full(len(owners), np.inf)
    chosen: list[int] = []
    while len(chosen) < POSES and apart.max(initial=0) > SAME:
        chosen.append(int(np.argmax(apart)))
        cosines = np.einsum("fji,ji->fj", turns, turns[chosen[-1]])
        cosines[:, root] = 1
        apart = np.minimum(apart, np.maximum(1 - cosines**2, 0).sum(axis=1))
        apart[chosen] = 0
    return [owners[index] for index in chosen]


def around(splats: Splats, texel: float, *, first: int) -> list[Camera]:
    """VIEWS cameras evenly over a sphere, which all see all splats; those of another `first` look from elsewhere."""
    box = box_of(splats.centres)
    cameras = []
    for number in range(VIEWS):
        elevation = float(np.arcsin(1 - (2 * number + 1) / VIEWS))
        azimuth = GOLDEN * (first + number)
        place = orbit(box, screen=(1, 1), azimuth=azimuth, elevation=elevation, fov=FOV).position
        width = 2 * np.tan(FOV / 2) * np.linalg.norm(place - box.mean(axis=0))
        side = int(np.clip(np.ceil(width / (PIXEL * max(texel, 1e-30))), 1, LARGEST_SIDE))
        cameras.append(orbit(box, screen=(side, side), azimuth=azimuth, elevation=elevation, fov=FOV))
    return cameras


def _shares_behind(splats: TorchSplats, bounds: torch.Tensor, normals: Array, camera: Camera) -> Array:
    """The largest share of a pixel that each splat gives, [N]; 0 where its triangle is not seen from behind."""
    shares = largest_shares(splats, Eye.of(camera, splats.centres), bounds, least=LARGEST_SHARE).numpy()
    return np.where(facing(splats.centres.numpy(), normals, camera.view) > AWAY, shares, 0)
