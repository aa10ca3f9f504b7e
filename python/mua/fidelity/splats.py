"""Draws splats by OpenGL: the formula of kernels/splat_draw, many times as fast as its reference on the CPU."""

from dataclasses import replace

import moderngl
import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera
from mua.avatar.decode import Splats
from mua.avatar.rendering import projected
from mua.fidelity.canvas import LAID_OVER, Canvas, draw, set_uniform
from mua.kernels.splat_draw import WEIGHT
from mua.kernels.splat_project import REACH, wide_deviations

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


class SplatPainter:
    """Draws posed splats onto one size of image."""

    def __init__(self, context: moderngl.Context, screen: tuple[int, int]) -> None:
        self._context = context
        self._program = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self._canvas = Canvas(context, screen, samples=SAMPLES, dtype="f4")
        set_uniform(self._program, "screen", self._canvas.size)

    def __call__(self, frame: Splats, camera: Camera) -> Array:
        """Premultiplied sRGB and alpha [H, W, 4] float32, as `render.render_premultiplied` has every sample."""
        splats = projected(frame, replace(camera, screen=self._canvas.size))
        visible = splats.order[splats.ellipses[splats.order, 4] > 0]
        ellipses, opacities = splats.ellipses[visible], splats.opacities[visible]
        wide = wide_deviations(ellipses[:, 4:6])
        rows = np.concatenate([ellipses, wide, splats.colors[visible], opacities[:, None]], axis=1)
        self._canvas.begin()
        self._context.enable_only(moderngl.BLEND)
        self._context.blend_func = LAID_OVER
        names = ("ellipse", "lengths", "shade")
        draw(self._program, rows, "4f 4f 4f/i", names, mode=moderngl.TRIANGLE_STRIP, vertices=4, instances=len(rows))
        return self._canvas.read()
