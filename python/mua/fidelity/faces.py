"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

import heapq
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import moderngl

from mua.arrays import Array
from mua.fidelity.measure import Agreement, agreement
from mua.fidelity.posed_source import Moment
from mua.fidelity.source_faces import Patch, source_faces
from mua.fidelity.source_process import SourceProcess, continued
from mua.fidelity.splat_faces import SplatFaces, StillFace
from mua.scene import Scene

AT_REST = "at rest"
LOST = 2.0  # decibels: an expression that loses more against the face at rest is worth a look
LOST_OVERLAP = 0.01  # the same of the silhouettes
PICTURED = 15  # expressions of many that are worth a place in a picture


@dataclass(frozen=True, eq=False)
class ExpressionShot:
    """A face in one expression, drawn from the file and as splats."""

    name: str
    agreement: Agreement
    at_rest: tuple[Array, Array]  # [H, W, 4] premultiplied sRGB and alpha, of source and splats
    other: tuple[Patch, Patch]  # in this expression

    @property
    def source(self) -> Array:
        return self.other[0].laid_over(self.at_rest[0])

    @property
    def splats(self) -> Array:
        return self.other[1].laid_over(self.at_rest[1])


@dataclass(frozen=True)
class FaceFidelity:
    """The face at rest and in each expression at weight 1."""

    rest: ExpressionShot
    expressions: tuple[ExpressionShot, ...]

    @property
    def worst(self) -> ExpressionShot:
        return min(self.expressions, key=lambda shot: shot.agreement.psnr)

    @property
    def least_like(self) -> tuple[ExpressionShot, ...]:
        """Up to PICTURED expressions that lose most against the face at rest, in the order of the file."""
        least = heapq.nlargest(PICTURED, self.expressions, key=self._lost)
        return tuple(shot for shot in self.expressions if shot in least)

    def _lost(self, shot: ExpressionShot) -> float:
        """From 1 on it is worth a look."""
        found, rest = shot.agreement, self.rest.agreement
        return max((rest.psnr - found.psnr) / LOST, (rest.iou - found.iou) / LOST_OVERLAP)


def compare_faces(
    context: moderngl.Context,
    face: StillFace,
    *,
    scene: Scene,
    rest: Moment,
    process: SourceProcess,
) -> FaceFidelity:
    """Draw source and splats at rest and in each expression alone, where no `process` has drawn them.

    The source's targets move the file's own meshes, which its own matrices then pose. The splats are those of the pose
    at rest, bent as an avatar bends them.
    """
    names = AT_REST, *face.expressions.names
    of_source = continued(process.faces(), source_faces(context, scene, rest, face.expressions.names))
    of_splats = process.splat_faces(SplatFaces(context, face))
    rest_shot, *shots = _shots(names, of_source, of_splats)
    return FaceFidelity(rest_shot, tuple(shots))


def _shots(names: Iterable[str], of_source: Iterable[Patch], of_splats: Iterable[Patch]) -> Iterator[ExpressionShot]:
    """Shots of source and splats, the first of them whole; others are measured where they are other."""
    rest: ExpressionShot | None = None
    for name, source, splats in zip(names, of_source, of_splats, strict=False):  # names first: no image more than these
        if rest is None:
            at_rest = source.image, splats.image
            yield (rest := ExpressionShot(name, agreement(*at_rest), at_rest, (source, splats)))
            continue
        part = source.area.joined(splats.area)
        before = agreement(part.of(at_rest[0]), part.of(at_rest[1]))
        after = agreement(source.laid_over_part(at_rest[0], part), splats.laid_over_part(at_rest[1], part))
        yield ExpressionShot(name, rest.agreement.changed(before, after), at_rest, (source, splats))
