"""Gaussian textures: empty texels, logarithms, logits, spherical harmonics, and the order of channels and texels."""

from collections.abc import Iterator

import numpy as np

from mua.arrays import Array
from mua.channels import APPEARANCE, ATTRIBUTES
from mua.recording.plausible.finding import Finding
from mua.rig.rig import Rig

SAMPLES = 4096  # texels that are checked
LARGE, SMALL = 8.0, 0.01  # steps between texels: a median length of splats far beyond any need
USUAL = 5.0  # factor of a step, or of a fifth of it: the usual length of splats
BASE_TEN = 2.5  # factor of a step: longer splats may have logarithms to base 10 if these bring them near a step
OFFSET, OFFSETS = 0.3, ATTRIBUTES["offset"]  # share of the figure's size, for the median splat
LOOSE = 0.15  # share of the figure's size: the median splat is nearer to the mesh, even in loose clothes
SMALLER = "are these centimetres or millimetres? metres are expected"
BRIGHT = 5.0  # limit of an SH constant: 1.4 times white above grey
SCALES_FIRST = "do the channels begin with the scales? offset 3, quaternion 4, log scale 3, opacity 1 are expected"
LOGARITHMS = {"millimetres": 1000.0, "centimetres": 100.0}


class Textures:
    """Checks the textures of one rig."""

    def __init__(
        self,
        rig: Rig,
        size: float,  # size of the figure, metres
    ) -> None:
        texels = rig.texels
        count = len(texels.texels)
        self._rows = np.unique(np.linspace(0, count - 1, min(count, SAMPLES)).astype(int))
        self._size, self._step = size, _step(rig)
        self._faces = rig.mesh.faces[texels.triangles[self._rows]]
        self._barycentrics = texels.barycentrics[self._rows]

    def __call__(
        self,
        texture: Array,  # [N, 23] at the valid texels
        mesh: Array,  # [V, 3] canonical
    ) -> Iterator[Finding]:
        """Likely mistakes in a texture of the right shape."""
        some = np.asarray(texture[self._rows], dtype=np.float64)
        empty: Array = np.linalg.norm(texture[:, ATTRIBUTES["rotation"]], axis=1) == 0
        if empty.any():
            yield _empty(empty)
            some = some[some[:, ATTRIBUTES["rotation"]].any(axis=1)]
        if len(some) and not empty.all():
            yield from self._scales(some)
            yield from self._offsets(some, mesh)
            yield from _opacities(some[:, ATTRIBUTES["opacity"]])
            yield from _colours(some[:, APPEARANCE].reshape(-1, 4, 3))

    def _scales(self, some: Array) -> Iterator[Finding]:
        """The median splat is about as long as the distance between texels."""
        longest = some[:, ATTRIBUTES["scale"]].max(axis=1)
        steps = self._steps(longest)
        base_ten = steps > BASE_TEN and 1 / BASE_TEN < self._steps(longest * np.log(10)) < BASE_TEN
        if SMALL < steps < LARGE and not base_ten:
            return
        found = f"texture: half of all splats are longer than {self._length(longest)}, of {_long(self._size)} in all"
        cause = self._scale_cause(some)
        if cause is not None and not SMALL < steps < LARGE:
            yield Finding(f"{found}: {cause}", certain=True)
        else:
            question = "to base 10" if base_ten or self._fits(longest * np.log(10)) else "right"
            expected = f"natural logarithms of about {_long(self._step)} are expected"
            yield Finding(f"{found}: are these logarithms {question}? {expected}", certain=False)

    def _scale_cause(self, some: Array) -> str | None:
        scales = some[:, ATTRIBUTES["scale"]]
        longest = scales.max(axis=1)
        if self._fits(some[:, OFFSETS].max(axis=1)):
            return SCALES_FIRST
        if (scales > 0).all() and self._fits(np.log(longest)):
            return "are these the scales themselves? their natural logarithms are expected"
        for unit, times in LOGARITHMS.items():
            if self._fits(longest - np.log(times)):
                return f"are these logarithms of {unit}? of metres is expected"
        return None

    def _offsets(self, some: Array, mesh: Array) -> Iterator[Finding]:
        """The median splat is near the mesh."""
        offsets = some[:, OFFSETS]
        away = float(np.median(np.linalg.norm(offsets, axis=1)))
        if away <= LOOSE * self._size:
            return
        found = f"texture: half of all offsets are longer than {_long(away)}, of {_long(self._size)} in all"
        if away <= OFFSET * self._size:
            yield Finding(f"{found}: {SMALLER}", certain=False)
            return
        surface = np.einsum("nvx,nv->nx", mesh[self._faces], self._barycentrics)
        if len(surface) == len(offsets) and np.median(np.linalg.norm(offsets - surface, axis=1)) < away / 4:
            question = "are these positions? offsets from the mesh are expected"
        elif self._fits(offsets.max(axis=1)):
            question = SCALES_FIRST
        else:
            question = SMALLER
        yield Finding(f"{found}: {question}", certain=True)

    def _fits(self, logarithms: Array) -> bool:
        """Whether the median splat would have an expected size."""
        return 1 / USUAL < self._steps(logarithms) < USUAL

    def _steps(self, logarithms: Array) -> float:
        return float(np.exp(min(np.median(logarithms), 50.0))) / self._step

    def _length(self, logarithms: Array) -> str:
        return _long(float(np.exp(min(np.median(logarithms), 50.0))))


def _empty(
    empty: Array,  # [N] bool
) -> Finding:
    count, of = int(empty.sum()), len(empty)
    if count == of:
        return Finding(
            "texture: all quaternions are zero, expected a rotation of any length: is it empty?", certain=True
        )
    question = (
        "does the teacher's texture leave texels empty that the rig's map holds, is it transposed or upside down?"
    )
    return Finding(f"texture: the quaternion is zero at {count} of {of} valid texels: {question}", certain=True)


def _opacities(logits: Array) -> Iterator[Finding]:
    if logits.min() >= 0 and logits.max() <= 1 and np.median(logits) > 0.5:
        found = f"texture: all opacities lie between {logits.min():.3g} and {logits.max():.3g}"
        yield Finding(f"{found}: are these opacities? logits, before the sigmoid, are expected", certain=False)


def _colours(
    sh: Array,  # [n, 4, 3] coefficient-major
) -> Iterator[Finding]:
    constant = sh[:, 0]
    other_order = sh.reshape(-1, 3, 4)[:, :, 0]  # as if all coefficients of red came first
    brightness = np.median(np.abs(constant))
    if brightness > BRIGHT:
        found = f"texture: half of the constant SH coefficients are beyond {brightness:.3g}"
        byte = constant.min() >= 0 and constant.max() <= 255
        question = "are these colours from 0 to 255?" if byte else "are these coefficients?"
        yield Finding(f"{found}: {question} (colour - 0.5) / 0.2821 is expected, colours in 0..1", certain=byte)
    elif np.abs(other_order[:, 1:]).mean() > max(3 * np.abs(constant[:, 1:]).mean(), 0.2):
        found = "texture: SH coefficients of degree 1 are larger than the constant ones of green and blue"
        question = "do all four of red come first? the constants of red, green and blue are expected first"
        yield Finding(f"{found}: {question}", certain=False)
    elif constant.min() >= 0 and constant.max() <= 1 and np.ptp(constant) > 0.5:
        found = f"texture: the constant SH coefficients lie between {constant.min():.3g} and {constant.max():.3g}"
        yield Finding(f"{found}: are these colours? (colour - 0.5) / 0.2821 is expected", certain=False)


def _step(rig: Rig) -> float:
    """The mean distance between neighbouring texels on the surface, metres."""
    used = np.unique(rig.texels.triangles)
    corners = rig.mesh.vertices[rig.mesh.faces[used]]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    return float(np.sqrt(areas.sum() / max(len(rig.texels.texels), 1))) or 1.0


def _long(metres: float) -> str:
    return f"{1000 * metres:.3g} mm" if metres < 0.1 else f"{metres:.3g} m"
