"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import astuple, dataclass

import moderngl

from mua.arrays import Array
from mua.fidelity.measure import Agreement, agreement
from mua.fidelity.posed_source import Moment
from mua.fidelity.source_faces import Patch, source_faces
from mua.fidelity.source_process import PICTURED, SourceProcess, continued
from mua.fidelity.splat_faces import StillFace, splat_faces
from mua.scene import Scene

AT_REST = "at rest"
LOST = 2.0  # decibels: an expression that loses more against the face at rest is worth a look
LOST_OVERLAP = 0.01  # the same of the silhouettes


@dataclass(frozen=True, eq=False)
class MeasuredExpression:
    """How like the file splats are in one expression."""

    name: str
    agreement: Agreement


@dataclass(frozen=True, eq=False)
class ExpressionShot(MeasuredExpression):
    """A face in one expression, drawn from the file and as splats."""

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
    """The face at rest and in each expression at weight 1, those least like the source in pictures."""

    rest: ExpressionShot
    expressions: tuple[MeasuredExpression, ...]

    @property
    def pictured(self) -> tuple[ExpressionShot, ...]:
        return tuple(shot for shot in self.expressions if isinstance(shot, ExpressionShot))

    @property
    def worst(self) -> MeasuredExpression:
        return min(self.expressions, key=lambda shot: shot.agreement.psnr)


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
    at rest, bent as an avatar bends them. Many expressions are measured with one sample in a pixel, and those least
    like the source then drawn.
    """
    names = face.expressions.names
    coarse = process.coarse(names)
    of_source = continued(process.faces(), source_faces(context, scene, rest, names, coarse=coarse))
    of_splats = continued(process.splat_faces(), splat_faces(context, face, names, coarse=coarse))
    if not coarse:
        rest_shot, *shots = _shots(names, of_source, of_splats)
        return FaceFidelity(rest_shot, tuple(shots))
    before, *after = _shots(names, of_source, of_splats)
    least_like = sorted(after, key=lambda shot: -_lost(shot.agreement, before.agreement))[:PICTURED]
    again = [shot.name for shot in after if shot in least_like]
    of_source = continued(process.draw_again(again), source_faces(context, scene, rest, again))
    rest_shot, *shots = _shots(again, of_source, splat_faces(context, face, again))
    drawn = {shot.name: shot for shot in shots}
    changed = (_changed(shot, before.agreement, rest_shot.agreement) for shot in after)
    return FaceFidelity(rest_shot, tuple(drawn.get(shot.name, shot) for shot in changed))


def _lost(found: Agreement, rest: Agreement) -> float:
    """How much less like the source than at rest an expression is: from 1 on it is worth a look."""
    return max((rest.psnr - found.psnr) / LOST, (rest.iou - found.iou) / LOST_OVERLAP)


def _changed(shot: MeasuredExpression, coarse: Agreement, rest: Agreement) -> MeasuredExpression:
    """The measurement at rest, changed by as much as that of few samples is changed by an expression."""
    sums = (astuple(agreement) for agreement in (rest, shot.agreement, coarse))
    return MeasuredExpression(shot.name, Agreement(*(max(a + b - c, 0) for a, b, c in zip(*sums, strict=True))))


def _shots(names: Iterable[str], of_source: Iterator[Patch], of_splats: Iterator[Patch]) -> Iterator[ExpressionShot]:
    """Shots of source and splats, the first of them whole."""
    at_rest: tuple[Array, Array] | None = None
    named = itertools.chain([AT_REST], names)
    for name, *other in zip(named, of_source, of_splats, strict=False):  # names first: no image more than these
        at_rest = at_rest or (other[0].image, other[1].image)
        images = [patch.laid_over(image) for patch, image in zip(other, at_rest, strict=True)]
        yield ExpressionShot(name, agreement(*images), at_rest, (other[0], other[1]))
