"""The part of the person that no training camera shows, so that a teacher has to guess it."""

from collections.abc import Sequence

import numpy as np

from mua.capture.capture import Capture
from mua.capture.fit import Posed, Seen
from mua.capture.silhouette import doubled_areas, shown

MUCH = 0.2  # of the surface: soles, armpits and the inside of clothes are less
NAMED = 3  # joints


def unseen_surface(capture: Capture, posed: Posed, views: Sequence[Seen]) -> list[str]:
    """A sentence where much of the template is outside all training images, or turned away from their cameras.

    What hides behind something else counts as seen.
    """
    tested = {clip.name for clip in capture.clips if clip.held_out}
    trained = [view for view in views if view.clip not in tested and not view.camera.held_out]
    if not trained:
        return []
    faces = posed.surfaces.faces
    seen = np.zeros(len(faces), bool)
    for view in trained:
        seen |= shown(posed.vertices[view.clip][view.frame][faces], view.camera)
    areas = np.linalg.norm(doubled_areas(posed.surfaces.vertices[faces]), axis=-1)
    share = float(areas[~seen].sum() / areas.sum())
    if share < MUCH:
        return []
    joints = posed.surfaces.skin_indices[faces[:, 0], posed.surfaces.skin_weights[faces[:, 0]].argmax(axis=1)]
    missing = np.bincount(joints, areas * ~seen)
    named = ", ".join(posed.surfaces.skeleton.names[j] for j in np.argsort(-missing)[:NAMED] if missing[j] > 0)
    return [
        f"No training camera shows {share:.0%} of the template in the frames that were looked at, most of it at "
        f"{named}: it will be guessed. Add cameras, or move them until the whole person is in their images."
    ]
