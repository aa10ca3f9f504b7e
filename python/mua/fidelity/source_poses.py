"""A character's file in some poses, from some sides, as its own meshes and matrices show it.

It loads little, because a process of its own may draw these images.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.fidelity.painter import Painter
from mua.fidelity.posed_source import Moment, skinned
from mua.scene import Scene

SCREEN = (384, 512)  # width, height, pixels
ABOVE = float(np.radians(5))


class Sitting(NamedTuple):
    """A pose and the sides from which it is drawn."""

    moment: Moment
    views: dict[str, float]  # degrees round the figure

    def places(self, scene: Scene) -> list[Array]:
        """The vertices [N, 3] of each part, world, metres."""
        return [skinned(scene, part, self.moment.nodes, self.moment.face) for part in scene.parts]

    def cameras(self, scene: Scene, places: Sequence[Array]) -> list[Camera]:
        """The camera of each view; in each the whole figure is in the image."""
        points = np.concatenate([at[np.unique(part.faces)] for at, part in zip(places, scene.parts, strict=True)])
        bounds = np.stack([points.min(axis=0), points.max(axis=0)])
        turns = [self.moment.yaw + float(np.radians(degrees)) for degrees in self.views.values()]
        return [orbit(bounds, screen=SCREEN, azimuth=turn, elevation=ABOVE) for turn in turns]


def source_poses(context: moderngl.Context, scene: Scene, sittings: Sequence[Sitting]) -> Iterator[Array]:
    """Images [H, W, 4] of all views of all poses."""
    paint = Painter(context, scene.parts, scene.materials, screen=SCREEN)
    for sitting in sittings:
        places = sitting.places(scene)
        for camera in sitting.cameras(scene, places):
            yield paint(places, camera)
