"""Fits a character's splats to images of its source, by gradient descent from many sides and in several poses.

Surfels laid on the surface leave gaps over creases, reach beyond edges and mix with what lies close behind them. What
mends that is the same in every frame: an offset, a size and a colour of each texel beside its own.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.avatar.camera import Camera, orbit
from mua.avatar.decode import box_of
from mua.channels import SH_C0
from mua.fidelity.canvas import opened
from mua.fidelity.compare import spread
from mua.fidelity.painter import Painter
from mua.fidelity.posed_source import Moment, Poser, skinned
from mua.fidelity.texel_adam import TexelAdam
from mua.pose.clip import Clip
from mua.rig.character import Character
from mua.scene import Source
from mua.splatting.posing import TorchRig, blend_texels, blend_vertices, place_splats, surface_points
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise
from mua.teachers.simulated.still import StillTeacher
from mua.training.threads import in_order, while_next
from mua.training.torch_threads import thread_share

STEPS = 200  # each of one image
AT_ONCE = 3  # images whose gradients are taken side by side: two cores then wait for nothing
POSES = 6  # beside that of the file
SIDE = 1.25  # pixels along an image for a texel along the texture: what is in it changes with both alike
SAMPLES = 2  # along a side of a pixel of the source: as good as 3, and half as many
NEARNESS = 4.0  # pixels for a texel in the middle of an image
ELEVATIONS = -0.35, 0.5  # radians
RATES = 3 * (0.3,) + 3 * (0.24,) + 3 * (0.015,)  # of offsets over a texel's width, log scales and display values
KNEE = 0.1  # of a display value: larger errors count by their size, smaller ones by its square
PRIOR = 2.0  # pixels for which each colour stands as it is: what few images show keeps its own
LAST_RATE = 0.1  # of a rate, in the last step
BEYOND = 1.1  # of the half of an image, within which the centre of a splat may lie
SMALLEST, LARGEST = -1.5, 0.7  # change of a log scale


@dataclass(frozen=True, eq=False)
class _Shown:
    """A pose of the uncorrected splats and of the source."""

    moment: Moment
    drawn: list[Array]  # vertices of the source's parts
    texel_dq: Tensor  # [N, 8] bind pose to world
    surface: Tensor  # [N, 3] canonical
    texture: Tensor  # [N, 23]
    bounds: Tensor  # [2, 3]
    centres: Array  # [N, 3]


@dataclass(frozen=True, eq=False)
class _View:
    """What a step descends on."""

    shown: _Shown
    camera: Camera
    source: Tensor  # [H, W, 4] premultiplied sRGB and alpha
    background: Tensor  # [3]
    rate: float  # of RATES


def fit(
    character: Character,
    clips: Sequence[Clip],
    *,
    teacher: StillTeacher,
    source: Source,
    steps: int = STEPS,
    progress: Callable[[int], None] = lambda done: None,
) -> Array:
    """What to add to the offsets, log scales and albedo of this character's still `teacher`, [N, 9] float32.

    Raises InputError where this machine has no OpenGL.
    """
    rng = np.random.default_rng(0)
    side = round(SIDE * teacher.rig.texels.size)
    poser = Poser(source, character.skeleton, character.expression_names)
    with opened() as context:
        parts, materials = source.scene.parts, source.scene.materials
        paint = Painter(context, parts, materials, screen=(side, side), samples=SAMPLES)
        poses = [_shown(teacher, moment, source, character) for moment in _moments(poser, clips)]
        return _descend(poses, paint, side=side, steps=steps, rng=rng, progress=progress)


def _descend(
    poses: Sequence[_Shown],
    paint: Painter,
    *,
    side: int,
    steps: int,
    rng: np.random.Generator,
    progress: Callable[[int], None],
) -> Array:
    """Adam on the errors of images, each on a background of its own."""
    count, threads = len(poses[0].texture), torch.get_num_threads()
    changes, adam, rates = torch.zeros(count, len(RATES)), TexelAdam(count, len(RATES)), torch.tensor(RATES)
    widths = poses[0].texture[:, 7:9].mean(dim=1, keepdim=True).exp()
    each = max(threads // AT_ONCE, 1)

    def views() -> Iterator[list[_View]]:
        for first in range(0, steps, AT_ONCE):
            yield [view(step) for step in range(first, min(first + AT_ONCE, steps))]

    def view(step: int) -> _View:
        shown = poses[step % len(poses)]
        camera, background = _camera(shown, widths, side=side, rng=rng), rng.uniform(size=3)
        source, rate = torch.tensor(paint(shown.drawn, camera)), LAST_RATE ** (step / steps)
        return _View(shown, camera, source, torch.tensor(background).float(), rate)

    def gradient_of(view: _View) -> tuple[Tensor, Tensor]:
        texels = torch.from_numpy(in_view(view.shown.centres, view.camera))
        own = changes[texels].requires_grad_()
        (gradient,) = torch.autograd.grad(_error(view, texels, own, _by(own, widths[texels]), threads=each), own)
        visible = gradient[:, :3].any(dim=1)  # the colour of the others has a gradient by PRIOR alone
        return texels[visible], gradient[visible]

    def descend(views: list[_View]) -> None:
        found = list(in_order(gradient_of, views, threads=AT_ONCE))  # all of them before the first step
        for view, (seen, gradient) in zip(views, found, strict=True):
            changes[seen] -= view.rate * rates * adam(seen, gradient)

    with thread_share(threads):  # its operations are too small to be divided
        for done, _ in enumerate(while_next(descend, views()), start=1):
            progress(min(AT_ONCE * done, steps))
    return np.asarray(_by(changes, widths).numpy())


def _error(view: _View, texels: Tensor, changes: Tensor, by: Tensor, *, threads: int) -> Tensor:
    """Charbonnier's, beside the square's where it is small, and the prior's."""
    shown, background = view.shown, view.background
    target = view.source[..., :3] + (1 - view.source[..., 3:]) * background
    splats = place_splats(shown.texel_dq[texels], shown.surface[texels], _corrected(shown.texture[texels], by))
    image = rasterise(splats, Eye.of(view.camera, shown.texture), shown.bounds, background, threads=threads)
    differs = ((image - target).square() + KNEE**2).sqrt()
    return 2 * KNEE * differs.sum() + PRIOR * changes[:, 6:].square().sum()


def _by(changes: Tensor, widths: Tensor) -> Tensor:
    """[N, 9], metres, of log scales and of display values."""
    offset, size, colour = changes.split(3, dim=1)
    return torch.cat([offset * widths, size.clamp(SMALLEST, LARGEST), colour], dim=1)


def in_view(centres: Array, camera: Camera) -> Array:
    """Which points [N, 3] a camera sees or nearly sees, int64 ascending: the others cost time and draw nothing."""
    clip = centres @ (camera.projection @ camera.view)[:, :3].T + (camera.projection @ camera.view)[:, 3]
    return np.flatnonzero((np.abs(clip[:, :2]) <= BEYOND * clip[:, 3:]).all(axis=1))


def _corrected(texture: Tensor, by: Tensor) -> Tensor:
    offset, size, colour = by.split(3, dim=1)
    beside = [texture.new_zeros(len(texture), channels) for channels in (4, 1, 9)]
    return texture + torch.cat([offset, beside[0], size, beside[1], colour / SH_C0, beside[2]], dim=1)


def _camera(shown: _Shown, widths: Tensor, *, side: int, rng: np.random.Generator) -> Camera:
    """A view from anywhere around the figure, about a texel, so near that this one is NEARNESS pixels wide."""
    at = int(rng.integers(len(shown.centres)))
    half = side * 2 * float(widths[at]) / NEARNESS / 2
    box = shown.centres[at] + half * np.array([[-1.0], [1.0]])
    azimuth, elevation = rng.uniform(0, 2 * np.pi), rng.uniform(*ELEVATIONS)
    return orbit(box, screen=(side, side), azimuth=azimuth, elevation=elevation)


def _moments(poser: Poser, clips: Sequence[Clip]) -> Iterator[Moment]:
    """The pose of the file and frames spread over all clips."""
    yield poser.rest()
    for clip, frame in spread(clips, POSES):
        yield poser.of_clip(clip, frame)


def _shown(teacher: StillTeacher, moment: Moment, source: Source, character: Character) -> _Shown:
    frame, scene = teacher.frame(moment.pose, moment.stretches), source.scene
    joints = torch.tensor(character.skeleton.skinning(moment.pose.rotations, moment.pose.translations)).float()
    texture = torch.tensor(frame.texture).float()
    rig = TorchRig.of(teacher.rig, texture)
    texel_dq = blend_texels(rig, blend_vertices(rig.skin_indices, rig.skin_weights, joints))
    surface = surface_points(rig, torch.tensor(frame.mesh).float())
    centres = place_splats(texel_dq, surface, texture).centres.numpy()
    return _Shown(
        moment=moment,
        drawn=[skinned(scene, part, moment.nodes, moment.face) for part in scene.parts],
        texel_dq=texel_dq,
        surface=surface,
        texture=texture,
        bounds=torch.tensor(box_of(centres)).float(),
        centres=centres,
    )
