"""Golden cases of the kernels from splats to their order, with inputs and bounds of the kernels' own tests."""

import numpy as np
from golden_case import UNTOUCHED, UNWRITTEN, Case, Expected, halves
from packed_splats import unpacked
from projected import Scene
from splat_rounding import ULP, exact_keys, eye_bounds
from stored import groups
from test_splat_project import BOX, packed_splats, stereo

from mua.arrays import Array
from mua.camera import NEAR, Camera
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import eye_ellipses, splat_project
from mua.kernels.splat_sort import DIGIT_BITS, splat_sort


def splat_project_cases() -> list[Case]:
    return [_project(1), _project(2), _scan(), _compact()]


def _scene(eyes: int) -> Scene:
    """Splats whose visibility, key and axes float32 cannot turn, before cameras that float32 holds exactly."""
    exact = [(c.view.astype(np.float32).astype(float), c.projection.astype(np.float32).astype(float)) for c in stereo()]
    cameras = tuple(Camera(view, projection, stereo()[0].screen) for view, projection in exact[:eyes])
    scene = Scene(packed_splats(1999, reach=1.6), cameras, (1.6 * BOX).astype(np.float32).astype(float))
    centres, covariance, opacities = scene.splats()
    keys, key_bound = exact_keys(centres, np.stack([c.view for c in cameras]), scene.bounds)
    clear = np.abs(keys - np.floor(keys) - 0.5) > 2 * key_bound
    for camera in cameras:
        bound = eye_bounds(centres, covariance, opacities, camera)
        ellipses = eye_ellipses(centres, covariance, camera.view, camera.projection, camera.screen, NEAR)
        clear &= (np.abs(bound.margin) > 2) & (bound.middle.max(axis=1) < 1e-3)
        clear &= (_axis_bound(ellipses, bound.variance) < 1e-3) & (ellipses[:, 2] > 0.01)
    return Scene(scene.words[clear][:283], cameras, scene.bounds)


def _axis_bound(ellipses: Array, variance_bound: Array) -> Array:
    """Bound [N] of the major axis: the covariance's error over the difference of its axes."""
    spread = (ellipses[:, 4] ** 2 - ellipses[:, 5] ** 2) / 2
    return np.asarray(variance_bound / np.maximum(spread, 1e-30) + 8 * ULP)


def _project(eyes: int) -> Case:
    scene = _scene(eyes)
    count = len(scene.words)
    fields = unpacked(scene.words)
    centres, covariance, opacities = scene.splats()
    constants = {
        name: np.float32(value) if name not in ("eyes", "splat_count", "instances") else value
        for name, value in scene.constants.items()
        if name != "instances"
    }
    views, projections = (constants[name][:eyes].astype(float) for name in ("view", "projection"))
    splats, keys, seen = splat_project(
        *(centres, covariance, opacities, views, projections),
        screen=scene.cameras[0].screen,
        near=float(constants["near"]),
        bounds=scene.bounds,
    )
    ellipses = np.full((eyes, count, 6), float(UNTOUCHED))
    ellipses[:, splats] = seen
    flags = np.zeros(count, np.uint32)
    flags[splats] = keys.astype(np.uint32) | 0x10000
    colors = np.zeros((count, 4))
    turn, sh = fields["turn"].astype(float), fields["sh"].astype(float)
    colors[splats, :3] = splat_colors(centres, turn, sh, constants["camera"][:3].astype(float))[splats]
    colors[splats, 3] = opacities[splats]
    counts = np.add.reduceat(flags > 0, np.arange(0, count, 256)).astype(np.uint32)

    bounds = [eye_bounds(centres, covariance, opacities, camera) for camera in scene.cameras]
    variance = np.max([bound.variance[splats] for bound in bounds], axis=0)
    middle = max(float(bound.middle[splats].max()) for bound in bounds)
    drawn = seen[..., 4] > 0
    axis = max(float(_axis_bound(e[d], variance[d]).max()) for e, d in zip(seen, drawn, strict=True))
    deviation = max(float((variance[d] / e[d, 5]).max()) for e, d in zip(seen, drawn, strict=True))
    direction = ULP * (3 / np.linalg.norm(centres - constants["camera"][:3], axis=1).min() + 28)
    return Case(
        f"{eyes} of two eyes",
        "SplatProject",
        groups((count, 256)),
        constants,
        {
            **{"splats": scene.words, "ellipses": np.full(ellipses.size, UNTOUCHED)},
            **{"colors": np.zeros(2 * count, np.uint32), "flags": np.full(count, UNWRITTEN)},
            "group_counts": np.full(len(counts), UNWRITTEN),
        },
        (
            Expected("ellipses", "float", ellipses[..., 0:2], middle, first=0, length=2, period=6),
            Expected("ellipses", "float", ellipses[..., 2:4], axis, first=2, length=2, period=6),
            Expected("ellipses", "float", ellipses[..., 4:6], deviation, 5 * ULP, first=4, length=2, period=6),
            halves("colors", colors, float(np.abs(sh).sum(axis=1).max()) * direction),
            Expected("flags", "uint", flags),
            Expected("group_counts", "uint", counts),
        ),
    )


def _scan() -> Case:
    splats = 300_007  # more groups than threads
    counts = np.random.default_rng(7).integers(0, 257, -(-splats // 256), dtype=np.uint32)
    total = int(counts.sum())
    arguments = np.array([6 * total, 2, 0, 0, -(-total // 2048), 1, 1, total], np.uint32)
    return Case(
        "300,007 splats",
        "ScanCounts",
        (1, 1, 1),
        {"splat_count": splats, "instances": 2},
        {"group_counts": counts, "arguments": np.full(8, UNWRITTEN)},
        (
            Expected("group_counts", "uint", (np.cumsum(counts) - counts).astype(np.uint32)),
            Expected("arguments", "uint", arguments),
        ),
    )


def _compact() -> Case:
    count, rng = 517, np.random.default_rng(8)
    flags = ((rng.random(count) < 0.4) * (0x10000 + rng.integers(0, 0x10000, count))).astype(np.uint32)
    counts = np.add.reduceat(flags > 0, np.arange(0, count, 256))
    visible = np.flatnonzero(flags).astype(np.uint32)
    rest = np.full(count - len(visible), UNWRITTEN)
    return Case(
        "three groups",
        "SplatCompact",
        groups((count, 256)),
        {"splat_count": count},
        {
            **{"flags": flags, "group_counts": (np.cumsum(counts) - counts).astype(np.uint32)},
            **{name: np.full(count, UNWRITTEN) for name in ("visible", "keys")},
        },
        (
            Expected("visible", "uint", np.append(visible, rest)),
            Expected("keys", "uint", np.append(flags[visible] & 0xFFFF, rest)),
        ),
    )


def splat_sort_cases() -> list[Case]:
    """Both passes over two groups of keys, many of them equal."""
    count, rng = 2048 + 517, np.random.default_rng(9)
    keys = (rng.integers(0, 40, count) * 0x333).astype(np.uint32)
    values = np.sort(rng.permutation(4 * count)[:count]).astype(np.uint32)
    after = splat_sort(keys.astype(np.uint16))
    low = np.argsort(keys & 0xFF, kind="stable")
    passes = ((0, keys, values, low), (DIGIT_BITS, keys[low], values[low], None))
    found = []
    for shift, pass_keys, pass_values, order in passes:
        sorted_keys = keys[after] if order is None else pass_keys[order]
        sorted_values = values[after] if order is None else pass_values[order]
        found += _sort_pass(shift, pass_keys, pass_values, sorted_keys, sorted_values)
    return found


def _sort_pass(shift: int, keys: Array, values: Array, sorted_keys: Array, sorted_values: Array) -> list[Case]:
    blocks = -(-len(keys) // 2048)
    arguments = np.array([6 * len(keys), 1, 0, 0, blocks, 1, 1, len(keys)], np.uint32)
    digits = (keys >> shift) & 0xFF
    counts = np.stack([np.bincount(d, minlength=256) for d in np.split(digits, range(2048, len(keys), 2048))], axis=1)
    before = np.cumsum(counts, axis=1) - counts
    counts, before, totals = (a.astype(np.uint32) for a in (counts, before, counts.sum(axis=1)))
    blank, name = np.full(len(keys), UNWRITTEN), f"shift {shift}"
    return [
        Case(
            *(name, "CountDigits", (blocks, 1, 1), {"shift": shift}),
            {"keys": keys, "arguments": arguments, "digit_counts": np.full(counts.size, UNWRITTEN)},
            (Expected("digit_counts", "uint", counts),),
        ),
        Case(
            *(name, "ScanDigits", (256, 1, 1), {}),
            {"arguments": arguments, "digit_counts": counts, "digit_totals": np.full(256, UNWRITTEN)},
            (Expected("digit_counts", "uint", before), Expected("digit_totals", "uint", totals)),
        ),
        Case(
            *(name, "ScatterDigits", (blocks, 1, 1), {"shift": shift}),
            {
                **{"keys": keys, "values": values, "arguments": arguments, "digit_counts": before},
                **{"digit_totals": totals, "sorted_keys": blank, "sorted_values": blank},
            },
            (Expected("sorted_keys", "uint", sorted_keys), Expected("sorted_values", "uint", sorted_values)),
        ),
    ]
