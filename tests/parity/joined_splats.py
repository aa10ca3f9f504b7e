"""Splats of several avatars in one scene."""

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.avatar.decode import Splats, box_of


def moved(frame: Splats, place: Array) -> Splats:
    """A posed avatar elsewhere."""
    return replace(
        frame,
        mesh=rotation.dual_transform(place, frame.mesh),
        centres=rotation.dual_transform(place, frame.centres),
        rotations=rotation.multiply(place[:4], frame.rotations),
        texel_dq=rotation.dual_multiply(place, frame.texel_dq),
        bounds=box_of(rotation.dual_transform(place, np.stack(np.meshgrid(*frame.bounds.T), axis=-1).reshape(-1, 3))),
    )


def joined(frames: Sequence[Splats]) -> Splats:
    """Frames as one, the box around all of theirs."""
    names = [field.name for field in fields(Splats) if field.name not in ("normals", "outside")]  # none is one-sided
    values: dict[str, Any] = {name: np.concatenate([getattr(frame, name) for frame in frames]) for name in names}
    whole = Splats(**values)
    return replace(whole, bounds=box_of(whole.bounds))
