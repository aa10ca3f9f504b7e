"""Golden cases of the kernels from texels to their order, with inputs and bounds of the kernels' own tests."""

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from golden_case import UNWRITTEN, Case, Expected, halves
from projected import Scene, held
from projected_cases import BOX, random_texels, stereo
from projection_errors import color_bound
from splat_rounding import CENTRE_BOUND, OPACITY_BOUND, ULP, exact_keys, eye_bounds
from stored import groups

from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera
from mua.avatar.decode import Splats
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import HIDDEN, eye_ellipses, pack_colors, pack_keys, splat_project
from mua.kernels.splat_sort import splat_sort

FIRST = 2  # splat of another avatar's, before those of a case
SEEN, UNSEEN = 241, 42
BLOCK = 2048


def splat_project_cases() -> list[Case]:
    return [_project(1), _project(2)]


def _scene(eyes: int) -> Scene:
    """Splats of which float32 turns no visibility, key, axis or step of a colour; the cameras are float32."""
    exact = [(c.view.astype(np.float32).astype(float), c.projection.astype(np.float32).astype(float)) for c in stereo()]
    cameras = tuple(Camera(view, projection, stereo()[0].screen) for view, projection in exact[:eyes])
    texels, box = random_texels(99_999), (1.6 * BOX).astype(np.float32).astype(float)
    texels.texture[:, 14:] *= 0.3  # less that depends on where the eye is
    texels = replace(texels, texture=held(texels.texture))
    splats = texels.splats
    clear = _clear_colors(splats, cameras)
    keys, key_bound = exact_keys(splats.centres, np.stack([c.view for c in cameras]), box)
    clear &= np.abs(keys - np.floor(keys) - 0.5) > key_bound
    for camera in cameras:
        bound, ellipses = eye_bounds(splats, camera), _ellipses(texels.splats, camera)
        clear &= (np.abs(bound.margin) > 2) & (_axis_bound(ellipses, bound.variance) < 1e-3) & (ellipses[:, 4] < 40)
        clear &= np.abs(np.abs(ellipses[:, 2:4]) - 0.5).max(axis=1) < 0.49  # no axis is beside one of the screen's
    seen = np.any([eye_bounds(splats, camera).margin > 0 for camera in cameras], axis=0)
    chosen = [*np.flatnonzero(clear & seen)[:SEEN], *np.flatnonzero(clear & ~seen)[:UNSEEN]]
    return Scene(texels.kept(np.array(chosen)), cameras, box)


def _colors(splats: Splats, cameras: Sequence[Camera]) -> Array:
    """Towards each eye, [E, N, 3]."""
    seen_from = splats.centres, splats.texel_dq, splats.sh
    return np.stack([splat_colors(*seen_from, camera.position) for camera in cameras])


def _clear_colors(splats: Splats, cameras: Sequence[Camera]) -> Array:
    """Splats [N] whose packed colours and opacity stay the same within what float32 may take from them."""
    colors, opacities = _colors(splats, cameras), splats.opacities
    distance = np.min([np.linalg.norm(splats.centres - c.position, axis=1) for c in cameras], axis=0)
    farthest = float(np.max([np.abs(c.position) for c in cameras]))
    bound = color_bound(splats.centres, splats.sh, distance, farthest)[:, None]
    packed = pack_colors(colors, opacities)
    clear = np.ones(len(opacities), bool)
    for either in itertools.product((-1, 1), repeat=len(cameras) + 1):
        moved = np.stack([np.maximum(c + sign * bound, 0) for c, sign in zip(colors, either, strict=False)])
        clear &= np.all(pack_colors(moved, opacities + either[-1] * OPACITY_BOUND) == packed, axis=1)
    return clear


def _ellipses(splats: Splats, camera: Camera) -> Array:
    covariance = covariances(splats.rotations, splats.scales)
    return eye_ellipses(splats.centres, covariance, camera.view, camera.projection, camera.screen, NEAR)


def _axis_bound(ellipses: Array, variance_bound: Array) -> Array:
    """Bound [N] of the major axis' direction: the covariance's error over the difference of its axes."""
    spread = (ellipses[:, 4] ** 2 - ellipses[:, 5] ** 2) / 2
    return np.asarray(variance_bound / np.maximum(spread, 1e-30) + 8 * ULP)


def _project(eyes: int) -> Case:
    scene = _scene(eyes)
    exact, before = scene.texels.splats, 8 * FIRST
    constants: dict[str, Any] = {
        name: np.float32(value) if name not in ("eyes", "texel_count") else value
        for name, value in scene.constants.items()
    }
    seen, keys, ellipses = splat_project(
        *(exact.centres, covariances(exact.rotations, exact.scales), exact.opacities),
        *(constants[name][:eyes].astype(float) for name in ("view", "projection")),
        screen=scene.cameras[0].screen,
        near=float(constants["near"]),
        bounds=scene.bounds,
        normals=exact.normals,
    )
    np.testing.assert_array_equal(seen, np.arange(SEEN))
    colors = pack_colors(_colors(exact, scene.cameras), exact.opacities)[:SEEN]
    pair = ellipses[0], ellipses[-1]
    axes = np.concatenate([e[:, 4:5] * e[:, 2:4] for e in pair], axis=1)
    minors = np.stack([e[:, 5] for e in pair], axis=1)
    bounds = [eye_bounds(exact, eye).variance[:SEEN] for eye in scene.cameras]
    deviation = max(float((v / np.maximum(e[:, 5], 0.01)).max()) for e, v in zip(ellipses, bounds, strict=True))
    deviation += 5 * ULP * float(ellipses[..., 4].max())
    turned = max(float((_axis_bound(e, v) * e[:, 4]).max()) for e, v in zip(ellipses, bounds, strict=True))
    hidden = before + 8 * SEEN
    return Case(
        f"{eyes} of two eyes",
        "SplatProject",
        groups((SEEN + UNSEEN, 256)),
        {**constants, "first_splat": FIRST},
        {
            **scene.texels.buffers,
            "splats": np.full((FIRST + SEEN + UNSEEN, 8), UNWRITTEN),
            "keys": np.full((FIRST + SEEN + UNSEEN + 1) // 2, UNWRITTEN),
        },
        (
            Expected("splats", "uint", np.full(before, UNWRITTEN)),
            Expected("splats", "float", exact.centres, CENTRE_BOUND, first=before, length=3, period=8),
            Expected("splats", "uint", colors, first=before + 3, length=2, period=8),
            halves("splats", axes, deviation + turned, first=before + 5, length=2, period=8),
            halves("splats", minors, deviation, first=before + 7, period=8),
            Expected("splats", "uint", np.zeros(UNSEEN), first=hidden + 3, period=8),
            Expected("splats", "uint", np.full(4 * UNSEEN, UNWRITTEN), first=hidden + 4, length=4, period=8),
            Expected("keys", "uint", np.full(FIRST // 2, UNWRITTEN)),
            Expected("keys", "uint", pack_keys(np.append(keys, [HIDDEN] * UNSEEN)), first=FIRST // 2),
        ),
    )


def splat_sort_cases() -> list[Case]:
    """Both passes over three groups of keys, many of them equal, some hidden, after which two groups are left."""
    count, rng = 2 * BLOCK + 517, np.random.default_rng(9)
    keys = (rng.integers(0, 40, count) * 0x333).astype(np.uint16)
    keys[rng.random(count) < 0.4] = HIDDEN
    visible = np.flatnonzero(keys != HIDDEN)
    low = visible[np.argsort(keys[visible] & 0xFF, kind="stable")]
    elements = (keys[low].astype(np.uint32) >> 8 << 24) | low.astype(np.uint32)
    arguments = np.array([3 * len(visible), 2, 0, 0, len(visible)], np.uint32)
    beyond = np.append(keys, np.uint16(0))  # the other half of the last word, no key of the sort
    first = _sort_pass(0, count, pack_keys(beyond), (visible, keys[visible] & 0xFF), elements, arguments)
    order = splat_sort(keys).astype(np.uint32)
    places = np.arange(len(visible))
    return first + _sort_pass(1, count, elements, (places, elements >> 24), order, arguments)


def _sort_pass(
    second_pass: int,
    count: int,
    keys: Array,
    digits: tuple[Array, Array],  # places among the pass's elements, and their digits
    expected: Array,
    arguments: Array,
) -> list[Case]:
    places, values = digits
    visible = len(places)
    blocks = -(-(visible if second_pass else count) // BLOCK)
    groups_of = (-(-count // BLOCK), 1, 1)  # the second pass leaves some of them idle
    owner = places // BLOCK
    counts: Array = np.stack([np.bincount(values[owner == block], minlength=256) for block in range(blocks)], axis=1)
    before: Array = np.cumsum(counts, axis=1) - counts
    counts, before, totals = (a.astype(np.uint32) for a in (counts, before, counts.sum(axis=1)))
    constants = {"second_pass": second_pass, "key_count": count}
    given = arguments if second_pass else np.full(5, UNWRITTEN)
    name = ("keys", "elements")[second_pass]
    return [
        Case(
            *(name, "CountDigits", groups_of, constants),
            {"keys": keys, "arguments": given, "digit_counts": np.full(counts.size, UNWRITTEN)},
            (Expected("digit_counts", "uint", counts),),
        ),
        Case(
            *(name, "ScanDigits", (16, 1, 1), constants),
            {"arguments": given, "digit_counts": counts, "digit_totals": np.full(256, UNWRITTEN)},
            (
                Expected("digit_counts", "uint", before),
                Expected("digit_totals", "uint", totals),
            ),
        ),
        Case(
            *(name, "ScatterDigits", groups_of, {**constants, "instances": 2, "corners": 3}),
            {
                **{"keys": keys, "arguments": given, "digit_counts": before, "digit_totals": totals},
                "sorted": np.full(count, UNWRITTEN),
            },
            (
                Expected("sorted", "uint", np.append(expected, np.full(count - visible, UNWRITTEN))),
                Expected("arguments", "uint", arguments),
            ),
        ),
    ]
