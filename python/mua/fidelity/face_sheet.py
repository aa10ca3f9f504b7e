"""The picture of a face's expressions: source, splats and their difference side by side for each of them."""

import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.fidelity.background import background_for, over
from mua.fidelity.faces import ExpressionShot, FaceFidelity
from mua.fidelity.source_faces import SCREEN
from mua.fidelity.strips import caption, difference, sheet

COLUMNS = 2  # expressions beside each other


def face_sheet(face: FaceFidelity, *, every: bool = False) -> Image.Image:
    """Three cells for the face at rest and for every expression, or of many for those least like the source."""
    background = background_for([face.rest.source])
    shots = face.expressions if every else face.least_like
    return sheet([_strip(shot, background) for shot in (face.rest, *shots)], COLUMNS)


def _strip(shot: ExpressionShot, background: float) -> Array:
    source, splats = over(shot.source, background), over(shot.splats, background)
    found = shot.agreement
    titles = (shot.name, f"splats: overlap {100 * found.iou:.1f} %, {found.psnr:.1f} dB", "difference")
    images = np.hstack([to_bytes(image) for image in (source, splats, difference(source, splats))])
    return np.vstack([caption(titles, SCREEN[0]), images])
