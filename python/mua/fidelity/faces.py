"""Each expression of a character, drawn from its file and as an avatar shows it: a close look at the face."""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import moderngl

from mua.arrays import Array
from mua.fidelity.face_process import FaceProcess
from mua.fidelity.measure import Agreement, agreement
from mua.fidelity.posing import Moment
from mua.fidelity.source_faces import Patch, source_faces
from mua.fidelity.splat_faces import StillFace, splat_faces
from mua.scene import Scene

AT_REST = "at rest"


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


def compare_faces(
    context: moderngl.Context,
    face: StillFace,
    *,
    scene: Scene,
    rest: Moment,
    process: FaceProcess,
) -> FaceFidelity:
    """Draw source and splats at rest and in each expression alone, where no `process` has drawn them.

    The source's targets move the file's own meshes, which its own matrices then pose. The splats are those of the pose
    at rest, bent as an avatar bends them.
    """
    names = AT_REST, *face.expressions.names
    of_source = _continued(process.source(), source_faces(context, scene, rest, face.expressions.names))
    of_splats = _continued(process.splats(), splat_faces(context, face))
    rest_shot, *shots = _shots(names, zip(of_source, of_splats, strict=True))
    return FaceFidelity(rest_shot, tuple(shots))


def _continued(drawn: Iterable[Patch], here: Iterator[Patch]) -> Iterator[Patch]:
    """What a process has drawn, and from where it stopped on what is drawn here."""
    count = 0
    for patch in drawn:
        count += 1
        yield patch
    yield from itertools.islice(here, count, None)


def _shots(names: Iterable[str], patches: Iterator[tuple[Patch, Patch]]) -> Iterator[ExpressionShot]:
    """Shots of source and splats, the first of them whole."""
    at_rest: tuple[Array, Array] | None = None
    for name, (of_source, of_splats) in zip(names, patches, strict=True):
        at_rest = at_rest or (of_source.image, of_splats.image)
        images = of_source.laid_over(at_rest[0]), of_splats.laid_over(at_rest[1])
        yield ExpressionShot(name, agreement(*images), at_rest, (of_source, of_splats))
