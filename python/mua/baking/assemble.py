"""From a trained student to the avatar that is written: playback clips, bounds, thumbnail."""

import io
from collections.abc import Sequence
from dataclasses import replace

from PIL import Image

from mua.asset.avatar import Avatar
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.baking.playback import typical_frame
from mua.baking.portrait import portrait
from mua.fidelity.background import background_for, over
from mua.pose.clip import Clip
from mua.pose.encoding import PoseEncoding
from mua.rig.bounds import playback_bounds
from mua.rig.rig import Rig
from mua.rig.triangulate import triangulate
from mua.student.export import export_branches, export_coarse, export_components
from mua.student.model import Student
from mua.student.shapes import wavelet_of
from mua.version import __version__

THUMBNAIL = 256  # pixels


def assemble(
    student: Student,
    rig: Rig,
    *,
    name: str,
    encoding: PoseEncoding,
    clips: Sequence[Clip],  # all that the character is known to do
    notes: str,
    bounded: Sequence[Clip] | None = None,  # what the bounds hold; None: the clips
    stored: Sequence[Clip] | None = None,  # clips to store for playback; None: all
) -> Avatar:
    """Everything that a player needs, as one avatar."""
    geometry, appearance = export_branches(student)
    avatar = Avatar(
        name=name,
        producer=f"mua {__version__}",
        rig=rig,
        encoding=encoding,
        components=export_components(student),
        coarse=export_coarse(student.coarse),
        geometry=geometry,
        appearance=appearance,
        wavelet=wavelet_of(student.wavelet),
        clips=tuple(clips if stored is None else stored),
        bounds=playback_bounds(rig, clips if bounded is None else bounded),
        thumbnail=b"",
        notes=notes,
        surface=triangulate(rig.mesh, rig.texels),
    )
    return replace(avatar, thumbnail=thumbnail(avatar, clips))


def thumbnail(avatar: Avatar, clips: Sequence[Clip]) -> bytes:
    """A PNG of a typical frame of the clips."""
    clip, index = typical_frame(clips, root=avatar.rig.skeleton.root)
    frame = decode_clip_frame(avatar, clip, frame=index)
    screen = (THUMBNAIL, THUMBNAIL)
    camera = portrait(frame, avatar.rig.skeleton, pose=clip.pose(index), screen=screen)
    stream = io.BytesIO()
    drawn = render_premultiplied(frame, camera)
    Image.fromarray(to_bytes(over(drawn, background_for([drawn])))).save(stream, "PNG")
    return stream.getvalue()
