"""From a trained student to the avatar that is written: playback clips, bounds, thumbnail."""

import io
from collections.abc import Sequence
from dataclasses import replace

from PIL import Image

from mua import __version__
from mua.asset.avatar import Avatar
from mua.bounds import playback_bounds
from mua.decode import decode_clip_frame
from mua.motion.clip import Clip
from mua.motion.encoding import PoseEncoding
from mua.portrait import portrait
from mua.render import render, to_bytes
from mua.rig.rig import Rig
from mua.student.export import export_branches, export_coarse, export_normalization, export_wavelet
from mua.student.model import Student

PLAYBACK_CLIPS = 8  # stored for playback; held-out ones first, so that a viewer sees what the student never saw
PLAYBACK_SECONDS = 10.0
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
    return clip.cut(slice(count))
