"""A capture's tracked points as training data: on the template, and on the texels nearest to them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import torch
from scipy.spatial import cKDTree
from torch import Tensor

from mua import rotation
from mua.arrays import Array
from mua.capture.tracks import PointTracks, read_tracks
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.rig.skinning import Skinning
from mua.rig.surface_points import face_normals, interpolate
from mua.teachers.trained.anchors import Anchors, anchors_of, places
from mua.teachers.trained.from_capture import Filmed
from mua.teachers.trained.mesh_losses import FACING
from mua.teachers.trained.template_training import Observations, Observed
from mua.teachers.trained.track_losses import TexelTracks, Tracks


@dataclass(frozen=True, eq=False)
class Tracked:
    """Observations of frames with their tracks."""

    seen: Observations
    tracks: Sequence[TexelTracks]  # [F]

    @property
    def descriptors(self) -> Tensor:
        return self.seen.descriptors

    @property
    def joints(self) -> Tensor:
        return self.seen.joints

    def observe(self, frame: int, generator: torch.Generator) -> Observed:
        return replace(self.seen.observe(frame, generator), tracks=self.tracks[frame].tracks)


def tracks_of(filmed: Filmed) -> list[TexelTracks]:
    """The tracks of all training frames; empty where the capture has none. Raises InputError where a file is wrong."""
    if filmed.capture.tracks is None and filmed.capture.tracks_2d is None:
        return []
    return [frame for clip in filmed.clips for frame in tracks_of_clip(filmed, clip)]


def tracks_of_clip(filmed: Filmed, clip: Clip) -> list[TexelTracks]:
    """The tracks of a clip's frames."""
    rig, read = filmed.subject.rig, read_tracks(filmed.capture, clip.name)
    joints = rig.skeleton.skinning(clip.rotations, clip.translations)
    skinning = Skinning(rig.skin_indices, rig.skin_weights)
    posed = np.stack([rotation.dual_transform(skinning(own), rig.mesh.vertices) for own in joints])
    size = figure_scale(rig.mesh.vertices)
    anchored = [_checked(anchors_of(one, rig.mesh, posed, size=size), one) for one in read]
    whole = Anchors(*(np.concatenate(of) for of in zip(*(_parts(one) for one in anchored), strict=True)))
    kept = whole.found
    corners, barycentrics = rig.mesh.faces[whole.triangles[kept]], whole.barycentrics[kept]
    texels = _nearest_texels(rig, whole)[kept]
    points, weights, rays = (np.concatenate(of, axis=1)[:, kept] for of in zip(*map(_seen, read), strict=True))
    corner, barycentric, texel = (_tensor(values, filmed.device) for values in (corners, barycentrics, texels))
    frames = (_tensor(values, filmed.device) for values in (points, weights, rays))
    return [TexelTracks(Tracks(corner, barycentric, *of_frame), texel) for of_frame in zip(*frames, strict=True)]


def _checked(anchors: Anchors, tracks: PointTracks) -> Anchors:
    if not anchors.found.any():
        raise InputError(f"{tracks.file}: no tracked point lies on the posed template; expected metres in its world")
    return anchors


def _parts(anchors: Anchors) -> tuple[Array, Array, Array]:
    return anchors.triangles, anchors.barycentrics, anchors.found


def _seen(tracks: PointTracks) -> tuple[Array, Array, Array]:
    """Points [F, P, 3], weights [F, P] and directions [F, P, 3], 0 of points that are places."""
    still = np.zeros_like(tracks.points) if tracks.directions is None else tracks.directions
    return tracks.points, tracks.weights, still


def _nearest_texels(rig: Rig, anchors: Anchors) -> Array:
    """The nearest texels [P] that face the same way."""
    vertices, faces, texels = rig.mesh.vertices, rig.mesh.faces, rig.texels
    normals = FACING * figure_scale(vertices) * face_normals(rig.mesh)
    own = interpolate(vertices, faces[texels.triangles], texels.barycentrics)
    points = places(anchors, vertices, faces)
    tree = cKDTree(np.concatenate([own, normals[texels.triangles]], axis=1))
    return np.asarray(tree.query(np.concatenate([points, normals[anchors.triangles]], axis=1))[1])


def _tensor(values: Array, device: torch.device) -> Tensor:
    tensor = torch.from_numpy(np.ascontiguousarray(values))
    return (tensor.float() if tensor.is_floating_point() else tensor.long()).to(device)
