"""From a trained student to the avatar that is written: playback clips, bounds, thumbnail."""

import io
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from PIL import Image

from mua import __version__, rotation
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.decode import decode_clip_frame
from mua.kernels.dq_skinning import blend_vertices
from mua.motion.clip import Clip
from mua.motion.encoding import PoseEncoding
from mua.portrait import portrait
from mua.render import render, to_bytes
from mua.rig.rig import Rig
from mua.student.export import export_branches, export_coarse, export_normalization, export_wavelet
from mua.student.model import Student

PLAYBACK_CLIPS = 8  # stored for playback; held-out ones first, so that a viewer sees what the student never saw
PLAYBACK_SECONDS = 10.0
MARGIN = 0.1  # metres that cloth may leave the skinned template
THUMBNAIL = 256  # pixels


def assemble(
    student: Student,
    rig: Rig,
    *,
    name: str,
    encoding: PoseEncoding,
    clips: Sequence[Clip],  # in order of preference
    notes: str,
) -> Avatar:
    """Everything that a player needs, as one avatar."""
    playback = tuple(_shortened(clip) for clip in clips[:PLAYBACK_CLIPS])
    geometry, appearance = export_branches(student)
    avatar = Avatar(
        name=name,
        producer=f"mua {__version__}",
        rig=rig,
        encoding=encoding,
        normalization=export_normalization(student),
        coarse=export_coarse(student.coarse),
        geometry=geometry,
        appearance=appearance,
        wavelet=export_wavelet(student),
        clips=playback,
        bounds=playback_bounds(rig, playback),
        thumbnail=b"",
        notes=notes,
    )
    return replace(avatar, thumbnail=thumbnail(avatar))


def playback_bounds(rig: Rig, clips: Sequence[Clip]) -> Array:
    """Lowest and highest corner [2, 3] float32 of the skinned template over all frames, about the root joint."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for clip in clips:
        _, placed = rig.skeleton.world(clip.rotations, clip.translation)
        for joints, root in zip(
            rig.skeleton.skinning(clip.rotations, clip.translation), placed[:, rig.skeleton.root], strict=True
        ):
            dual = blend_vertices(joints, rig.skin_indices, rig.skin_weights)
            posed = rotation.dual_transform(dual, rig.mesh.vertices) - root
            low, high = np.minimum(low, posed.min(axis=0)), np.maximum(high, posed.max(axis=0))
    return np.stack([low - MARGIN, high + MARGIN]).astype(np.float32)


def thumbnail(avatar: Avatar) -> bytes:
    """A PNG of the first playback clip's middle frame."""
    clip = avatar.clips[0]
    index = len(clip) // 2
    frame = decode_clip_frame(avatar, clip, frame=index)
    screen = (THUMBNAIL, THUMBNAIL)
    camera = portrait(frame, avatar.rig.skeleton, pose=clip.pose(index), screen=screen)
    stream = io.BytesIO()
    Image.fromarray(to_bytes(render(frame, camera))).save(stream, "PNG")
    return stream.getvalue()


def _shortened(clip: Clip) -> Clip:
    count = int(PLAYBACK_SECONDS * clip.rate)
    return replace(clip, rotations=clip.rotations[:count], translation=clip.translation[:count])
