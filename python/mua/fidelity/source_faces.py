"""Each expression of a character as its file draws it: a close look at the face.

It loads little, because a process of its own draws these images.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.fidelity.canvas import Area
from mua.fidelity.painter import Painter
from mua.fidelity.posed_source import Moment, expressed, skinned
from mua.scene import Part, Scene

SCREEN = (288, 288)  # width, height, pixels
MOVES = 0.1  # of how far an expression moves any vertex: those that it moves more are in the picture
USUAL = 97  # percent of the vertices that are moved: a hat that one expression lifts does not make the picture
AWAY = float(np.radians(15))  # of the view from the front, so that depth shows


class Patch(NamedTuple):
    """A part of an image."""

    area: Area
    image: Array  # [h, w, 4]

    def laid_over(self, image: Array) -> Array:
        """An image [H, W, 4] with this part of it."""
        whole = image.copy()
        self.area.of(whole)[:] = self.image
        return whole

    def laid_over_part(self, image: Array, part: Area) -> Array:
        """A part of an image [H, W, 4], in which this one lies, with it."""
        whole, (left, top, *_) = part.of(image).copy(), part
        height, width = self.image.shape[:2]
        whole[self.area.top - top :, self.area.left - left :][:height, :width] = self.image
        return whole


def source_faces(context: moderngl.Context, scene: Scene, rest: Moment, names: Sequence[str]) -> Iterator[Patch]:
    """The image of the file's own meshes at rest, and what is other in that of each expression alone."""
    of_source = _Source(context, scene, rest, camera_of(scene, rest))
    yield Patch(Area(0, 0, *SCREEN), of_source.at_rest)
    yield from map(of_source.expressed, names)


class _Source:
    """Draws the file's own meshes; for an expression only where it moves them."""

    def __init__(self, context: moderngl.Context, scene: Scene, rest: Moment, camera: Camera) -> None:
        self._scene, self._rest, self._camera = scene, rest, camera
        self._paint = Painter(context, scene.parts, scene.materials, screen=SCREEN)
        self._places = [skinned(scene, part, rest.nodes) for part in scene.parts]
        shown = [_shown(part, at, camera) for part, at in zip(scene.parts, self._places, strict=True)]
        self._paint.near_first(self._places, camera, shown)
        self.at_rest = self._paint(self._places, camera)

    def expressed(self, name: str) -> Patch:
        """What is other in one expression."""
        places, moved = list(self._places), [np.empty((0, 3))]
        for index, part in enumerate(self._scene.parts):
            if vertices := [target.vertices for target in part.targets if target.name == name]:
                at = np.unique(np.concatenate(vertices))
                places[index] = self._places[index].copy()
                places[index][at] = skinned(self._scene, _with_target(part, name, at), self._rest.nodes)
                corners = np.unique(part.faces[_among(at, part)[part.faces].any(axis=1)])
                moved += [of[index][corners] for of in (self._places, places)]
        area = Area.of_points(np.concatenate(moved), self._camera)
        return Patch(area, area.of(self.at_rest) if area.empty else self._paint(places, self._camera, area))


def _with_target(part: Part, name: str, at: Array) -> Part:
    """Some vertices of a part with one of its targets at weight 1."""
    positions = expressed(part, {name: 1.0})[at]
    return replace(part, positions=positions, joints=part.joints[at], weights=part.weights[at], targets=())


def _among(at: Array, part: Part) -> Array:
    """Whether each of a part's vertices [N] is one of some."""
    held = np.zeros(len(part.positions), bool)
    held[at] = True
    return held


def _shown(part: Part, places: Array, camera: Camera) -> Array:
    """Which of a part's triangles [F] may be in the image: all but those beyond one of its sides that nothing moves."""
    pixels, depths = camera.pixels(places)
    sides = np.column_stack([pixels < 0, pixels > camera.screen]) & (depths > camera.near)[:, None]
    moved = _among(np.concatenate([np.empty(0, int), *(target.vertices for target in part.targets)]), part)
    beyond = np.asarray(sides[part.faces].all(axis=1)).any(axis=1)
    return np.asarray(~beyond | moved[part.faces].any(axis=1))


def camera_of(scene: Scene, rest: Moment) -> Camera:
    """The camera that looks at what expressions move."""
    return orbit(_box(scene), screen=SCREEN, azimuth=rest.yaw + AWAY)


def _box(scene: Scene) -> Array:
    """The box [2, 3] about what expressions usually move, as the file stands."""
    found = []
    for part in scene.parts:
        moved = np.zeros(len(part.positions), bool)
        for target in part.targets:
            lengths = np.linalg.norm(target.offsets, axis=1)
            moved[target.vertices[lengths > MOVES * lengths.max(initial=0)]] = True
        moved &= np.isin(np.arange(len(moved)), part.faces)
        found.append(skinned(scene, part, scene.rest)[moved])
    return np.percentile(np.concatenate(found), [100 - USUAL, USUAL], axis=0)
