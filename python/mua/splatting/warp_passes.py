"""The passes of the rasteriser over the pixels of tiles, for the CPU and for CUDA from one source.

    alpha = peak (1 - u^2) (1 - v^2),   u = uu dx + uv dy,   v = uv dx + vv dy
    image = sum_i T_i alpha_i (color_i, 1),   T_i = product of (1 - alpha_j) over the quads j before i

(dx, dy) from the quad's middle to the pixel's centre. `shapes` are those of mua.splatting.projection.Quads. A pixel is
done when its transmittance T falls to LEAST_TRANSMITTANCE. The second pass walks back from there and divides T by
1 - alpha again, so that a pixel keeps two numbers, however many quads lie over it. A third pass finds the
largest T_i alpha_i of each quad instead of an image.

A thread has one block of pixels of a tile, a lane of its vectors for each: eight on a CPU, whose instructions compute
with eight numbers at once, one on CUDA.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, valid-type, no-untyped-call"
# mypy: disable-error-code="call-overload, arg-type"
# (the bodies of the kernels are Warp's language, not Python)

from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from mua.splatting.tiles import TILE
from mua.training.warp_start import NO_NANS, start

LEAST_TRANSMITTANCE = 1e-5  # what lies behind changes no 8-bit image

start()


@dataclass(frozen=True, eq=False)
class Passes:
    """The kernels in one precision, for one size of block."""

    forward: wp.Kernel
    backward: wp.Kernel
    weigh: wp.Kernel


@cache
def passes(
    real: Any,  # wp.float32 or wp.float64
    block: tuple[int, int],  # columns and rows of the pixels of a thread; divisors of TILE
) -> Passes:
    """The kernels, whose launches have a thread for each block of each tile."""
    lanes = block[0] * block[1]
    line = wp.types.vector(length=lanes, dtype=real)
    across = wp.constant(TILE // block[0])
    per_tile = wp.constant(TILE * TILE // lanes)
    columns, rows = (wp.constant(side) for side in block)
    least = wp.constant(real(LEAST_TRANSMITTANCE))
    one, two, huge = (wp.constant(real(value)) for value in (1.0, 2.0, 1e30))
    zeros, ones = (wp.constant(line(*[value] * lanes)) for value in (0.0, 1.0))
    middles = [[lane % block[0] + 0.5 for lane in range(lanes)], [lane // block[0] + 0.5 for lane in range(lanes)]]
    right, down = (wp.constant(line(*offsets)) for offsets in middles)

    @wp.struct
    class Block:
        x: line  # centres of its pixels
        y: line
        column: wp.int32  # of its first pixel
        row: wp.int32
        width: wp.int32  # of the screen
        height: wp.int32
        pixel: wp.int32  # of the screen, the first into the images
        first: wp.int32  # pair of its tile
        end: wp.int32

    @wp.struct
    class Place:
        x: line  # from the quad's middle, pixels
        y: line
        u: line  # -1 to 1 at the quad's edges
        v: line
        across: line  # 1 - u^2, at least 0
        along: line

    @wp.func
    def block_of(thread: int, places: wp.array2d[wp.int32], starts: wp.array[wp.int32]):
        own = Block()
        tile = thread // per_tile
        inner = thread % per_tile
        own.column = places[tile, 0] + (inner % across) * columns
        own.row = places[tile, 1] + (inner // across) * rows
        own.x = right + real(own.column) * ones
        own.y = down + real(own.row) * ones
        own.width = places[tile, 2]
        own.height = places[tile, 3]
        own.pixel = places[tile, 4]
        own.first = starts[tile]
        own.end = starts[tile + 1]
        return own

    @wp.func
    def pixel_of(own: Block, lane: int):
        """The row of the images that a lane has, -1 outside the screen."""
        column = own.column + lane % columns
        row = own.row + lane // columns
        return wp.where(column < own.width and row < own.height, own.pixel + row * own.width + column, -1)

    @wp.func
    def place_in(own: Block, shapes: wp.array2d[real], quad: int):
        place = Place()
        place.x = own.x - shapes[quad, 0] * ones
        place.y = own.y - shapes[quad, 1] * ones
        place.u = shapes[quad, 2] * place.x + shapes[quad, 3] * place.y
        place.v = shapes[quad, 3] * place.x + shapes[quad, 4] * place.y
        place.across = wp.max(ones - wp.cw_mul(place.u, place.u), zeros)
        place.along = wp.max(ones - wp.cw_mul(place.v, place.v), zeros)
        return place

    @wp.func
    def positive(values: line):
        """1 where a value is above 0, else 0: a choice without branches."""
        return wp.min(wp.max(huge * values, zeros), ones)

    @wp.kernel(enable_backward=False, module="unique", module_options=NO_NANS)
    def forward(
        places: wp.array2d[wp.int32],
        starts: wp.array[wp.int32],
        quads: wp.array[wp.int32],
        shapes: wp.array2d[real],
        colors: wp.array2d[real],
        image: wp.array2d[real],  # [P, 4] the pixels of all screens
        left: wp.array[real],  # [P] transmittance behind the last quad
        ends: wp.array[wp.int32],  # [P] pair behind the last that was blended
    ):
        own = block_of(wp.tid(), places, starts)
        transmittance = one * ones
        red = one * zeros
        green = one * zeros
        blue = one * zeros
        blended = one * zeros  # quads
        pair = own.first
        while pair < own.end and wp.max(transmittance) > least:
            quad = quads[pair]
            place = place_in(own, shapes, quad)
            goes_on = positive(transmittance - least * ones)
            alpha = shapes[quad, 5] * wp.cw_mul(place.across, place.along)
            weight = wp.cw_mul(wp.cw_mul(transmittance, goes_on), alpha)
            red += colors[quad, 0] * weight
            green += colors[quad, 1] * weight
            blue += colors[quad, 2] * weight
            transmittance -= weight
            blended += goes_on
            pair += 1
        for lane in range(lanes):
            pixel = pixel_of(own, lane)
            if pixel >= 0:
                image[pixel, 0] = red[lane]
                image[pixel, 1] = green[lane]
                image[pixel, 2] = blue[lane]
                image[pixel, 3] = one - transmittance[lane]
                left[pixel] = transmittance[lane]
                ends[pixel] = own.first + int(blended[lane])

    @wp.kernel(enable_backward=False, module="unique", module_options=NO_NANS)
    def backward(
        places: wp.array2d[wp.int32],
        starts: wp.array[wp.int32],
        quads: wp.array[wp.int32],
        shapes: wp.array2d[real],
        colors: wp.array2d[real],
        left: wp.array[real],
        ends: wp.array[wp.int32],
        wanted: wp.array2d[real],  # [P, 4] gradient of the images
        shapes_gradient: wp.array2d[real],  # [M, 6]
        colors_gradient: wp.array2d[real],  # [M, 3]
    ):
        own = block_of(wp.tid(), places, starts)
        red = one * zeros
        green = one * zeros
        blue = one * zeros
        covered = one * zeros
        transmittance = one * zeros
        blended = one * zeros
        for lane in range(lanes):
            pixel = pixel_of(own, lane)
            if pixel >= 0:
                red[lane] = wanted[pixel, 0]
                green[lane] = wanted[pixel, 1]
                blue[lane] = wanted[pixel, 2]
                covered[lane] = wanted[pixel, 3]
                transmittance[lane] = left[pixel]
                blended[lane] = real(ends[pixel] - own.first)
        behind = one * zeros  # what the quads behind add to the loss
        before = int(wp.max(blended))
        while before > 0:
            before -= 1
            quad = quads[own.first + before]
            place = place_in(own, shapes, quad)
            shown = wp.cw_mul(place.across, place.along)
            shown = wp.cw_mul(shown, positive(blended - real(before) * ones))
            if wp.max(shown) > real(0.0):
                peak = shapes[quad, 5]
                alpha = peak * shown
                kept = wp.cw_div(ones, ones - alpha)
                transmittance = wp.cw_mul(transmittance, kept)
                weight = wp.cw_mul(transmittance, alpha)
                value = red * colors[quad, 0] + green * colors[quad, 1] + blue * colors[quad, 2] + covered
                by_alpha = wp.cw_mul(transmittance, value) - wp.cw_mul(behind, kept)
                behind += wp.cw_mul(weight, value)
                wp.atomic_add(colors_gradient, quad, 0, wp.dot(weight, red))
                wp.atomic_add(colors_gradient, quad, 1, wp.dot(weight, green))
                wp.atomic_add(colors_gradient, quad, 2, wp.dot(weight, blue))
                by_window = (-two * peak) * wp.cw_mul(by_alpha, positive(shown))
                by_u = wp.cw_mul(by_window, wp.cw_mul(place.u, place.along))
                by_v = wp.cw_mul(by_window, wp.cw_mul(place.v, place.across))
                sum_u = wp.dot(by_u, ones)
                sum_v = wp.dot(by_v, ones)
                wp.atomic_add(shapes_gradient, quad, 0, -shapes[quad, 2] * sum_u - shapes[quad, 3] * sum_v)
                wp.atomic_add(shapes_gradient, quad, 1, -shapes[quad, 3] * sum_u - shapes[quad, 4] * sum_v)
                wp.atomic_add(shapes_gradient, quad, 2, wp.dot(place.x, by_u))
                wp.atomic_add(shapes_gradient, quad, 3, wp.dot(place.y, by_u) + wp.dot(place.x, by_v))
                wp.atomic_add(shapes_gradient, quad, 4, wp.dot(place.y, by_v))
                wp.atomic_add(shapes_gradient, quad, 5, wp.dot(by_alpha, shown))

    @wp.kernel(enable_backward=False, module="unique", module_options=NO_NANS)
    def weigh(
        places: wp.array2d[wp.int32],
        starts: wp.array[wp.int32],
        quads: wp.array[wp.int32],
        shapes: wp.array2d[real],
        largest: wp.array[real],  # [M] weight in any pixel
        smallest: real,  # of the weights that count
    ):
        own = block_of(wp.tid(), places, starts)
        transmittance = one * zeros
        for lane in range(lanes):
            if pixel_of(own, lane) >= 0:
                transmittance[lane] = one
        pair = own.first
        while pair < own.end and wp.max(transmittance) > least and wp.max(transmittance) >= smallest:
            quad = quads[pair]
            place = place_in(own, shapes, quad)
            goes_on = positive(transmittance - least * ones)
            alpha = shapes[quad, 5] * wp.cw_mul(place.across, place.along)
            weight = wp.cw_mul(wp.cw_mul(transmittance, goes_on), alpha)
            if wp.max(weight) >= smallest:
                wp.atomic_max(largest, quad, wp.max(weight))
            transmittance -= weight
            pair += 1

    return Passes(forward, backward, weigh)
