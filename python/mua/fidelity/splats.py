"""Draws splats by OpenGL: the formula of kernels/splat_draw, many times as fast as its reference on the CPU."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.avatar.decode import Splats
from mua.avatar.rendering import visible
from mua.fidelity.canvas import LAID_OVER, Area, Canvas, draw, set_uniform
from mua.kernels.splat_draw import WEIGHT, splat_colors
from mua.kernels.splat_project import REACH, half_extents, wide_deviations

BEYOND = 1 << 16  # all keys
SHARES = np.arange(1, 9) / 9  # of the quads, that layers have
SAMPLES = 2  # samples along a side of a pixel; thin splats in one pixel then cover different parts of it

VERTEX = """
#version 330
uniform vec2 screen;
in vec4 ellipse; // centre column and row, cosine and sine of the major axis
in vec4 lengths; // standard deviations along and across, those of what is drawn
in vec4 shade; // colour and opacity
out vec2 corner;
flat out vec4 tint;
void main()
{
    corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    vec2 apart = lengths.w * corner + (lengths.z - lengths.w) * dot(ellipse.zw, corner) * ellipse.zw;
    vec2 at = ellipse.xy + REACH * apart;
    gl_Position = vec4(at.x / screen.x * 2.0 - 1.0, 1.0 - at.y / screen.y * 2.0, 0.0, 1.0);
    tint = vec4(shade.rgb, shade.a * WEIGHT * (lengths.x / lengths.z) * (lengths.y / lengths.w));
}
"""
FRAGMENT = """
#version 330
in vec2 corner;
flat in vec4 tint;
out vec4 color;
void main()
{
    vec2 window = 1.0 - min(corner * corner, 1.0);
    float alpha = tint.a * window.x * window.y;
    color = vec4(tint.rgb * alpha, alpha);
}
"""
for name, number in {"REACH": float(REACH), "WEIGHT": WEIGHT}.items():
    VERTEX = VERTEX.replace(name, str(number))


@dataclass(frozen=True, eq=False)
class Quads:
    """What a camera sees of N splats, M of them, ready to be drawn."""

    splats: Array  # [M] int, ascending
    keys: Array  # [M] uint16, ascending from back to front
    rows: Array  # [M, 12] the inputs of VERTEX, pixels of the canvas

    def exchanged(
        self,
        some: Array,  # [n] int, splats that have moved
        by: "Quads",  # what is seen of these, as splats 0 to n - 1
    ) -> "Quads":
        """The same with some splats elsewhere."""
        stay = ~np.isin(self.splats, some)
        splats = np.concatenate([self.splats[stay], some[by.splats]])
        order = np.argsort(splats, kind="stable")
        keys, rows = np.concatenate([self.keys[stay], by.keys]), np.concatenate([self.rows[stay], by.rows])
        return Quads(splats[order], keys[order], rows[order])

    def among(self, some: Array) -> "Quads":
        """What is seen of some of the splats."""
        held = np.isin(self.splats, some)
        return self._where(held)

    def between(self, first: int, end: int = BEYOND) -> "Quads":
        """Those whose keys are at least `first` and less than `end`."""
        return self._where((self.keys >= first) & (self.keys < end))

    def _where(self, held: Array) -> "Quads":
        return Quads(self.splats[held], self.keys[held], self.rows[held])


class Layer(NamedTuple):
    """An image of what lies behind a depth, to draw the rest onto."""

    key: int  # of the first quad that is not in it
    image: moderngl.Framebuffer | None  # None: nothing


NOTHING = Layer(0, None)


class SplatPainter:
    """Draws posed splats onto one size of image."""

    def __init__(self, context: moderngl.Context, screen: tuple[int, int]) -> None:
        self._context, self._screen = context, screen
        self._program = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self._canvas = Canvas(context, screen, samples=SAMPLES, dtype="f4")
        set_uniform(self._program, "screen", self._canvas.size)

    def __call__(self, frame: Splats, camera: Camera) -> Array:
        """Premultiplied sRGB and alpha [H, W, 4] float32, as `render.render_premultiplied` has every sample."""
        return self.drawn(self.quads(frame, camera))

    def quads(self, frame: Splats, camera: Camera) -> Quads:
        """The splats that a camera sees."""
        splats, keys, (ellipses,) = visible(frame, replace(camera, screen=self._canvas.size))
        wide = wide_deviations(ellipses[:, 4:6])
        sh, opacities = frame.sh[splats], frame.opacities[splats, None]
        colors = splat_colors(frame.centres[splats], frame.texel_dq[splats], sh, camera.position)
        return Quads(splats, keys, np.concatenate([ellipses, wide, colors, opacities], axis=1))

    def drawn(self, quads: Quads, area: Area | None = None, behind: Layer = NOTHING) -> Array:
        """The image [H, W, 4] of some quads, or a part of it; a layer has those `behind` its key already."""
        self._canvas.begin(area, behind.image)
        self._lay(quads.between(behind.key))
        return self._canvas.read(area)

    def layers(self, quads: Quads) -> list[Layer]:
        """Layers of some quads, from back to front, that have about as many of them more each."""
        self._canvas.begin()
        layers = [NOTHING]
        for key in np.unique(np.quantile(quads.keys, SHARES, method="lower")).tolist():
            self._lay(quads.between(layers[-1].key, key))
            layers.append(Layer(key, self._canvas.copy()))
        return layers

    def _lay(self, quads: Quads) -> None:
        """Draw quads over what is there."""
        rows = quads.rows[np.argsort(quads.keys, kind="stable")]
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = LAID_OVER
        names = ("ellipse", "lengths", "shade")
        draw(self._program, rows, "4f 4f 4f/i", names, mode=moderngl.TRIANGLE_STRIP, vertices=4, instances=len(rows))

    def area(self, *quads: Quads) -> Area:
        """The part of the image that quads cover."""
        rows = np.concatenate([some.rows for some in quads])
        middle, half = rows[:, :2] / SAMPLES, half_extents(rows[:, :6]) / SAMPLES
        return Area.about(middle - half, middle + half, self._screen)
