"""Round an avatar's numbers to what an image shows, so that they deflate to a fraction: multiples of powers of two.

The steps of the static offset, by channel, are the unit. Every other number is rounded so that it moves the texels, all
together, about as many steps as one number of the static offset does: then no number costs more bytes than it is worth.
Multiples of a power of two are exact as f16, so that a reader has nothing to do.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.model import Branch, Coarse, DetailBand, Layer, Mlp
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS, GEOMETRY
from mua.limits import LARGEST
from mua.pose.encoding import Components
from mua.rig.expressions import Expressions

# Steps of the static offset, measured in docs/research/storage.md; that of an offset is of the figure's height.
STEPS = {"offset": 2.0**-16, "rotation": 2.0**-8, "scale": 2.0**-7, "opacity": 2.0**-6, "SH": 2.0**-8}
STATIC, LL, DETAILS, WEIGHTS = 0.8, 0.8, 0.4, 0.4  # times the step that follows
GAIN = 2.0**-7  # of a colour
FIGURE = 400  # pixels along a figure: errors of texels that are smaller than one average out
POSES = 512  # random ones, by which networks are measured
FAINT = 1 / 16  # of a layer's mean output, below which units count as if they were that large
MOST_STEPS = 127  # of a byte, either way
RAISED = 2.0  # times the squared error of a tensor's steps, that storing it as bytes may cost
DEVIATIONS = 6.0  # of a component of poses, between the ends of its range


def rounded(avatar: Avatar, rounding: float = 1.0) -> Avatar:
    """The same avatar with its bases, its static offset, the weights of its MLPs and its expressions in steps.

    What a triangle map gives back, and what a person reads, stays as it is. All steps are times `rounding`.
    """
    height = float(np.ptp(avatar.coarse.mean, axis=0).max(initial=0)) or 1.0
    steps, poses = rounding * channel_steps(height), _poses(avatar.components)
    fine = max(1.0, height / (FIGURE * (avatar.rig.texels.length or np.inf))) ** 0.5
    carried = max(1.0, len(avatar.rig.texels.texels) / len(avatar.coarse.mean))  # texels by each vertex
    mesh = steps[0] / carried**0.5
    return replace(
        avatar,
        coarse=_coarse(avatar.coarse, mesh, poses),
        geometry=_branch(avatar.geometry, fine * steps[GEOMETRY], fine, poses),
        appearance=_branch(avatar.appearance, fine * steps[APPEARANCE], fine, poses),
        rig=replace(avatar.rig, expressions=_expressions(avatar.rig.expressions, mesh)),
    )


def _expressions(expressions: Expressions | None, step: float) -> Expressions | None:
    if expressions is None:
        return None
    gains = None if expressions.gains is None else in_steps(expressions.gains, GAIN)
    return replace(expressions, offsets=in_steps(expressions.offsets, step), gains=gains)


def channel_steps(height: float) -> Array:
    """Steps [23] of the static offset of a figure of so many metres."""
    steps = np.zeros(CHANNELS)
    for name, channels in ATTRIBUTES.items():
        steps[channels] = STEPS[name]
    steps[ATTRIBUTES["offset"]] *= height
    return steps


def in_steps(values: Array, steps: Array | float) -> Array:
    """Multiples of the powers of two nearest to `steps`, which broadcast over the values."""
    return _multiples(values, _powers(steps))


def rows_in_steps(
    values: Array,  # [..., n]
    steps: Array,  # [..., 1]
) -> Array:
    """The same with larger steps in the few rows that have more of them than a byte holds, if it is few.

    A tensor whose rows all fit in bytes is stored as i8 by `mua.asset.packing`: half the memory for whoever plays it.
    """
    powers = _powers(steps)
    most = np.abs(values).max(axis=-1, keepdims=True)
    raised = powers * np.exp2(np.ceil(np.log2(np.maximum(most / (MOST_STEPS * powers), 1))))
    few = np.mean((raised / powers) ** 2) < RAISED
    return _multiples(values, raised if few else powers)


def _planes_in_steps(
    values: Array,  # [..., a, b]
    steps: Array,  # [...]
) -> Array:
    return rows_in_steps(values.reshape(*steps.shape, -1), steps[..., None]).reshape(values.shape)


def _powers(steps: Array | float) -> Array:
    return np.asarray(np.exp2(np.rint(np.log2(steps))))


def _multiples(values: Array, powers: Array) -> Array:
    whole = np.rint(values.astype(np.float64) / powers) + 0.0  # no -0, which has bytes of its own
    return np.asarray(whole * powers, dtype=np.float32)


def _poses(components: Components) -> Array:
    """Inputs of the networks [POSES, K] about as training had them, always the same."""
    low, high = components.ranges
    spread = (high - low) / DEVIATIONS
    drawn = np.random.default_rng(0).normal(size=(POSES, len(spread)))
    return np.asarray(np.clip(drawn * spread, low, high))


def _coarse(
    coarse: Coarse,
    step: float,
    poses: Array,  # [P, K]
) -> Coarse:
    mlp, sizes = _mlp(coarse.mlp, poses, _norm(coarse.basis.reshape(len(coarse.basis), -1) / step)[:, 0])
    return replace(coarse, mlp=mlp, basis=_planes_in_steps(coarse.basis, step / sizes))


def _branch(
    branch: Branch,
    steps: Array,  # [C]
    fine: float,  # times by which errors of single texels may be larger than those of many
    poses: Array,  # [P, K]
) -> Branch:
    mlp, sizes = _mlp(branch.mlp, poses, _reach(branch, steps))
    ranks = np.array(branch.ranks)
    ll, *levels = (
        part.reshape(branch.channels, -1) for part in np.split(sizes, np.cumsum(branch.channels * ranks)[:-1])
    )
    return replace(
        branch,
        mlp=mlp,
        ll_mean=in_steps(branch.ll_mean, steps[:, None, None]),
        ll_basis=_planes_in_steps(branch.ll_basis, LL * steps[:, None] / ll),
        details=tuple(_detail(band, steps[:, None], own) for band, own in zip(branch.details, levels, strict=True)),
        static=in_steps(branch.static, STATIC * fine * steps[:, None]),
    )


def _detail(
    band: DetailBand,
    steps: Array,  # [C, 1]
    sizes: Array,  # [C, R] of the coefficients
) -> DetailBand:
    """An error in one factor counts as much as the other is large."""
    own = (DETAILS * steps / sizes)[..., None]
    return DetailBand(
        mean=in_steps(band.mean, steps[..., None]),
        h=in_steps(band.h, own / _nonzero(_norm(band.w))),
        w=in_steps(band.w, own / _nonzero(_norm(band.h))),
    )


def _reach(branch: Branch, steps: Array) -> Array:
    """By how many steps of its channel each coefficient moves all texels together, [C R of LL + C R of each detail]."""
    parts = [_norm(branch.ll_basis.reshape(*branch.ll_basis.shape[:2], -1))[..., 0]]
    parts += [np.sqrt(((_norm(band.h) * _norm(band.w))[..., 0] ** 2).sum(axis=0)) for band in branch.details]
    return np.concatenate([(part / steps[:, None]).ravel() for part in parts])


def _mlp(
    mlp: Mlp,
    poses: Array,  # [P, K]
    reach: Array,  # [M] steps that texels move by, for a unit of an output
) -> tuple[Mlp, Array]:
    """The MLP in steps, and the root mean square [M] of its outputs, not below what is faint."""
    mlp = _balanced(mlp, poses)
    inputs, outputs = list(zip(*_outputs(mlp, poses), strict=True))
    layers = []
    for number, layer in reversed(list(enumerate(mlp))):
        steps = WEIGHTS / _nonzero(reach)
        layers.append(Layer(rows_in_steps(layer.weight, steps[:, None]), layer.bias))
        fires = np.mean(inputs[number] > 0, axis=0)
        reach = np.sqrt(np.maximum(fires, FAINT) * ((reach[:, None] * layer.weight) ** 2).sum(axis=0))
    return _sorted(tuple(reversed(layers))), _size(outputs[-1])


def _sorted(mlp: Mlp) -> Mlp:
    """An equal function, its units by how many weights read them: zeros of a row that lie together deflate best."""
    for number in range(len(mlp) - 1):
        one, next_ = mlp[number : number + 2]
        order = np.argsort(-np.count_nonzero(next_.weight, axis=0), kind="stable")
        pair = Layer(one.weight[order], one.bias[order]), Layer(next_.weight[:, order], next_.bias)
        mlp = (*mlp[:number], *pair, *mlp[number + 2 :])
    return mlp


def _balanced(
    mlp: Mlp,
    poses: Array,  # [P, K]
) -> Mlp:
    """An equal function whose hidden units are all about 1, so that the weights of one row have one step."""
    powers = [np.rint(np.log2(_size(np.maximum(out, 0)))).astype(int) for _, out in _outputs(mlp, poses)]
    before = [np.zeros(mlp[0].weight.shape[1], int), *powers[:-1]]
    after = [*powers[:-1], np.zeros(len(mlp[-1].bias), int)]
    balanced = tuple(
        Layer(np.ldexp(layer.weight, into - out[:, None]), np.ldexp(layer.bias, -out))
        for layer, into, out in zip(mlp, before, after, strict=True)
    )
    largest = max(float(np.abs(part).max()) for layer in balanced for part in (layer.weight, layer.bias))
    return balanced if largest <= LARGEST else mlp


def _outputs(mlp: Mlp, poses: Array) -> Iterator[tuple[Array, Array]]:
    """What goes into each layer and what comes out of it."""
    for layer in mlp:
        out = poses @ layer.weight.T + layer.bias
        yield poses, out
        poses = np.maximum(out, 0)


def _size(values: Array) -> Array:
    """Root mean squares [M] over poses [P, M]; those far below their mean are raised, and 1 where all are 0."""
    sizes = np.sqrt(np.mean(values.astype(np.float64) ** 2, axis=0))
    return np.maximum(sizes, FAINT * sizes.mean()) if sizes.any() else np.ones_like(sizes)


def _norm(values: Array) -> Array:
    """Along the last axis, which stays."""
    return np.asarray(np.sqrt((values.astype(np.float64) ** 2).sum(axis=-1, keepdims=True)))


def _nonzero(values: Array) -> Array:
    return np.maximum(values, np.finfo(np.float32).tiny)
