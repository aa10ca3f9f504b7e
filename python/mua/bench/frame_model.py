"""How long a frame would take on a device that is not at hand: counts over published rates, with their uncertainty.

    a kernel    the longer of its bytes over the bandwidth and its operations over the rate
    triangles   of every eye, over the triangles a second, once for each pass
    fragments   the longer of blending them and of their instructions over the rate; these run in blocks of 2 x 2
                pixels, whole where a triangle touches one

Stages follow one another, without gaps between dispatches. No avatar hides another. One avatar decodes half in a
displayed frame, several one part of one decode (mua.avatar.decode_turns).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from mua.bench.counts import Counts, Drawn, Part, halves
from mua.bench.devices import ModelDevice
from mua.bench.work import PROJECT_EYE, Work

ENDS = ("best", "likely", "worst")
# A triangle that is half of a square of side s has the perimeter (2 + sqrt 2) s, and a convex shape turned at random is
# on average as wide as its perimeter over pi. Grown by a pixel along either axis, it covers as much as the blocks do.
BLOCK_EDGE = 2 * (2 + np.sqrt(2)) / np.pi  # fragments per unit of s, beside those inside
BLOCK_CORNER = 1  # pixels
FIXED = 16  # instructions of a fragment for interpolation and blending, assumed


@dataclass(frozen=True)
class Stages:
    """Milliseconds of a displayed frame."""

    decode: float  # decode of all parts
    part: float  # the longest share of a decode in a displayed frame, of one avatar for all
    pose: float  # to sorted splats
    triangles: float
    fragments: float
    rest: float

    @property
    def plain(self) -> float:
        """Milliseconds of a frame that does not decode."""
        return self.pose + self.triangles + self.fragments + self.rest

    @property
    def spread(self) -> float:
        """Milliseconds of a frame that decodes one part."""
        return self.part + self.plain

    @property
    def whole(self) -> float:
        """Milliseconds of a frame that decodes everything."""
        return self.decode + self.plain


@dataclass(frozen=True)
class Modelled:
    """Times for one or several avatars from one distance."""

    distance: float  # metres
    avatars: int
    eyes: int
    ends: dict[str, Stages]  # by ENDS

    @property
    def likely(self) -> Stages:
        return self.ends["likely"]


def model(device: ModelDevice, counts: Counts, instructions: int) -> list[Modelled]:
    """1 and 3 avatars, one eye and both, from all distances; `instructions` are those of a fragment."""
    modelled = []
    for avatars, eyes, seen in product((1, 3), (1, 2), counts.drawn):
        ends = {end: _stages(device, counts, seen, avatars, eyes, instructions, end) for end in ENDS}
        modelled.append(Modelled(seen.distance, avatars, eyes, ends))
    return modelled


def _stages(
    device: ModelDevice, counts: Counts, seen: Drawn, avatars: int, eyes: int, instructions: int, end: str
) -> Stages:
    parts = parts_ms(device, counts.decode, end)
    shares = [sum(half) for half in halves(parts)] if avatars == 1 else parts
    triangles, fragments = (avatars * eyes * each for each in drawing_ms(device, seen, instructions, end))
    return Stages(
        decode=avatars * sum(parts),
        part=max(shares),
        pose=avatars * pose_ms(device, counts.pose, counts.splats, eyes, end),
        triangles=triangles,
        fragments=fragments,
        rest=getattr(device.rest, end),
    )


def drawing_ms(device: ModelDevice, seen: Drawn, instructions: int, end: str) -> tuple[float, float]:
    """Milliseconds of triangles and of fragments, of one avatar for one eye."""
    triangles = seen.triangles * device.passes / (1e9 * device.clock * getattr(device.triangles, end))
    computed = shaded(seen) * (instructions + FIXED) / (1e12 * device.peak / 2 * getattr(device.shading, end))
    blended = seen.fragments / (1e9 * device.clock * getattr(device.pixels, end))
    return 1e3 * triangles, 1e3 * max(computed, blended)


def parts_ms(device: ModelDevice, decode: Sequence[Part], end: str) -> list[float]:
    return [kernels_ms(device, part.kernels, end) for part in decode]


def pose_ms(device: ModelDevice, pose: Part, splats: int, eyes: int, end: str) -> float:
    """Milliseconds from a decode to sorted splats; what was counted is for one eye."""
    kernels = dict(pose.kernels)
    project = kernels["SplatProject"]
    kernels["SplatProject"] = replace(project, flops=project.flops + (eyes - 1) * PROJECT_EYE * splats)
    return kernels_ms(device, kernels, end)


def kernels_ms(device: ModelDevice, work: Mapping[str, Work], end: str) -> float:
    """Milliseconds of kernels one after the other."""
    moved = 1e9 * device.bandwidth * getattr(device.copy, end)
    computed = 1e12 * device.peak * getattr(device.compute, end)
    return 1e3 * sum(max(each.bytes / moved, each.flops / computed) for each in work.values())


def shaded(seen: Drawn) -> float:
    """Fragments with those that run only to fill blocks of 2 x 2; triangles are halves of squares of one size."""
    if seen.fragments == 0:
        return 0.0
    side = np.sqrt(2 * seen.fragments / seen.triangles)
    return float(seen.fragments + seen.triangles * (BLOCK_EDGE * side + BLOCK_CORNER))
