"""The passes of the rasteriser over the pixels of tiles, for the CPU and for CUDA from one source.

    alpha = peak (1 - u^2) (1 - v^2),   u = uu dx + uv dy,   v = uv dx + vv dy
    image = sum_i T_i alpha_i (color_i, 1),   T_i = product of (1 - alpha_j) over the quads j before i

(dx, dy) from the quad's middle to the pixel's centre. `shapes` are those of mua.splatting.projection.Quads. A pixel is
done when its transmittance T falls to LEAST_TRANSMITTANCE. The second pass walks back from there and divides T by
1 - alpha again, so that a pixel keeps two numbers, however many quads lie over it. A third pass finds the
largest T_i alpha_i of each quad instead of an image.
"""

# mypy: disable-error-code="index, operator, attr-defined, no-untyped-def, valid-type, no-untyped-call"
# mypy: disable-error-code="call-overload, arg-type"
# (the bodies of the kernels are Warp's language, not Python)

from dataclasses import dataclass
from functools import cache
from typing import Any

import warp as wp

from mua.splatting.tiles import TILE
from mua.training.warp_start import start

LEAST_TRANSMITTANCE = 1e-5  # what lies behind changes no 8-bit image

start()


@dataclass(frozen=True, eq=False)
class Passes:
    """The kernels in one precision."""

    forward: wp.Kernel
    backward: wp.Kernel
    weigh: wp.Kernel


@cache
def passes(real: Any) -> Passes:
    """The kernels for wp.float32 or wp.float64."""
    tile = wp.constant(TILE)
    least = wp.constant(real(LEAST_TRANSMITTANCE))
    one, two, half, zero = (wp.constant(real(value)) for value in (1.0, 2.0, 0.5, 0.0))

    @wp.struct
    class Pixel:
        x: real  # its centre, pixels
        y: real
        at: wp.int32  # into the images, row by row; -1 outside
        first: wp.int32  # pair of its tile
        end: wp.int32

    @wp.struct
    class Place:
        x: real  # from the quad's middle, pixels
        y: real
        u: real  # -1 to 1 at the quad's edges
        v: real

    @wp.func
    def pixel_of(thread: int, places: wp.array2d[wp.int32], starts: wp.array[wp.int32]):
        pixel = Pixel()
        owner = thread // (tile * tile)
        inner = thread % (tile * tile)
        column = places[owner, 0] + inner % tile
        row = places[owner, 1] + inner // tile
        width = places[owner, 2]
        pixel.x = real(column) + half
        pixel.y = real(row) + half
        inside = column < width and row < places[owner, 3]
        pixel.at = wp.where(inside, places[owner, 4] + row * width + column, -1)
        pixel.first = starts[owner]
        pixel.end = starts[owner + 1]
        return pixel

    @wp.func
    def place_in(pixel: Pixel, shapes: wp.array2d[real], quad: int):
        place = Place()
        place.x = pixel.x - shapes[quad, 0]
        place.y = pixel.y - shapes[quad, 1]
        place.u = shapes[quad, 2] * place.x + shapes[quad, 3] * place.y
        place.v = shapes[quad, 3] * place.x + shapes[quad, 4] * place.y
        return place

    @wp.func
    def window(place: Place):
        return wp.max(one - place.u * place.u, zero) * wp.max(one - place.v * place.v, zero)

    @wp.kernel(enable_backward=False, module="unique")
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
        pixel = pixel_of(wp.tid(), places, starts)
        if pixel.at < 0:
            return
        transmittance = one
        red = zero
        green = zero
        blue = zero
        pair = pixel.first
        while pair < pixel.end and transmittance > least:
            quad = quads[pair]
            alpha = shapes[quad, 5] * window(place_in(pixel, shapes, quad))
            weight = transmittance * alpha
            red += weight * colors[quad, 0]
            green += weight * colors[quad, 1]
            blue += weight * colors[quad, 2]
            transmittance -= weight
            pair += 1
        image[pixel.at, 0] = red
        image[pixel.at, 1] = green
        image[pixel.at, 2] = blue
        image[pixel.at, 3] = one - transmittance
        left[pixel.at] = transmittance
        ends[pixel.at] = pair

    @wp.kernel(enable_backward=False, module="unique")
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
        pixel = pixel_of(wp.tid(), places, starts)
        if pixel.at < 0:
            return
        red = wanted[pixel.at, 0]
        green = wanted[pixel.at, 1]
        blue = wanted[pixel.at, 2]
        transmittance = left[pixel.at]
        behind = zero  # what the quads behind add to the loss
        pair = ends[pixel.at] - 1
        while pair >= pixel.first:
            quad = quads[pair]
            place = place_in(pixel, shapes, quad)
            shown = window(place)
            pair -= 1
            if shown > zero:
                peak = shapes[quad, 5]
                alpha = peak * shown
                transmittance /= one - alpha
                weight = transmittance * alpha
                value = red * colors[quad, 0] + green * colors[quad, 1] + blue * colors[quad, 2] + wanted[pixel.at, 3]
                by_alpha = transmittance * value - behind / (one - alpha)
                behind += weight * value
                wp.atomic_add(colors_gradient, quad, 0, weight * red)
                wp.atomic_add(colors_gradient, quad, 1, weight * green)
                wp.atomic_add(colors_gradient, quad, 2, weight * blue)
                by_u = -two * place.u * (one - place.v * place.v) * peak * by_alpha
                by_v = -two * place.v * (one - place.u * place.u) * peak * by_alpha
                wp.atomic_add(shapes_gradient, quad, 0, -shapes[quad, 2] * by_u - shapes[quad, 3] * by_v)
                wp.atomic_add(shapes_gradient, quad, 1, -shapes[quad, 3] * by_u - shapes[quad, 4] * by_v)
                wp.atomic_add(shapes_gradient, quad, 2, place.x * by_u)
                wp.atomic_add(shapes_gradient, quad, 3, place.y * by_u + place.x * by_v)
                wp.atomic_add(shapes_gradient, quad, 4, place.y * by_v)
                wp.atomic_add(shapes_gradient, quad, 5, by_alpha * shown)

    @wp.kernel(enable_backward=False, module="unique")
    def weigh(
        places: wp.array2d[wp.int32],
        starts: wp.array[wp.int32],
        quads: wp.array[wp.int32],
        shapes: wp.array2d[real],
        largest: wp.array[real],  # [M] weight in any pixel
        smallest: real,  # of the weights that count
    ):
        pixel = pixel_of(wp.tid(), places, starts)
        if pixel.at < 0:
            return
        transmittance = one
        pair = pixel.first
        while pair < pixel.end and transmittance > least and transmittance >= smallest:
            quad = quads[pair]
            weight = transmittance * shapes[quad, 5] * window(place_in(pixel, shapes, quad))
            if weight >= smallest:
                wp.atomic_max(largest, quad, weight)
            transmittance -= weight
            pair += 1

    return Passes(forward, backward, weigh)
