"""Draws triangles as a file describes them: their own textures, no light, several samples in every pixel."""

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from PIL import Image

from mua.arrays import Array
from mua.atlas.filtering import bled
from mua.atlas.opacity import EDGE, cut_out
from mua.avatar.camera import Camera
from mua.fidelity.canvas import LAID_OVER, Area, Canvas, draw, set_uniform
from mua.scene import Material, Part

SAMPLES = 3  # samples along a side of a pixel; odd, so that no coverage is exactly one half
LARGEST = 2048  # texels along a side of a texture; the images show no more
FILTERING = 8.0  # samples along a texture that is seen at a slant
SLICES = 16  # of the depth, in which triangles are drawn from front to back
SOLID = 0.99  # opacity from which a surface hides all behind it

VERTEX = """
#version 330
uniform mat4 matrix;
in vec3 place;
in vec2 coordinates;
in vec4 factor; // linear
out vec2 uv;
out vec4 tint;
void main() { uv = coordinates; tint = factor; gl_Position = matrix * vec4(place, 1.0); }
"""
FRAGMENT = """
#version 330
uniform sampler2D picture;
uniform bvec2 mirrored;
uniform bool solid; // draw what hides all behind it, else the rest
uniform float cutoff; // of a mask whose vertices change its opacity, else 0
in vec2 uv;
in vec4 tint;
out vec4 color;
vec3 linear(vec3 s) { return mix(pow((s + 0.055) / 1.055, vec3(2.4)), s / 12.92, lessThan(s, vec3(0.04045))); }
vec3 srgb(vec3 l) { return mix(1.055 * pow(l, vec3(1.0 / 2.4)) - 0.055, l * 12.92, lessThan(l, vec3(0.0031308))); }
void main()
{
    vec2 at = mix(uv, 1.0 - abs(mod(uv, 2.0) - 1.0), mirrored);
    vec4 texel = textureGrad(picture, at, dFdx(uv), dFdy(uv));
    texel = vec4(srgb(linear(texel.rgb) * tint.rgb), texel.a * tint.a);
    if (cutoff > 0.0) texel.a = step(cutoff, texel.a);
    if ((texel.a >= SOLID) != solid) discard;
    color = vec4(texel.rgb * texel.a, texel.a);
}
""".replace("SOLID", str(SOLID))


@dataclass(eq=False)
class _Piece:
    """The triangles of one part on the device."""

    corners: Array  # [3 F] int, vertices of the part
    inputs: Array  # [3 F, 6] float32, texture coordinates and the colour that multiplies the texture
    material: int
    clear: bool  # whether any of its material is transparent


class Painter:
    """Draws the parts of a scene in any pose."""

    def __init__(
        self,
        context: moderngl.Context,
        parts: Sequence[Part],
        materials: Sequence[Material],
        *,
        screen: tuple[int, int],  # width, height, pixels
        samples: int = SAMPLES,  # along a side of a pixel
    ) -> None:
        self._context, self._materials = context, materials
        self._program = context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self._canvas = Canvas(context, screen, samples=samples, dtype="f1")
        palettes = {part.material for part in parts if _is_palette(part)}
        shown = sorted({part.material for part in parts})
        self._cut_late = {part.material for part in parts if _is_thinned(part, materials[part.material])}
        self._textures = {
            m: _texture(context, materials[m], slanted=m not in palettes, cut=m not in self._cut_late) for m in shown
        }
        self._pieces = [_piece(part, materials[part.material]) for part in parts]

    def __call__(
        self,
        places: Sequence[Array],  # for each part its vertices [N, 3], world, metres
        camera: Camera,
        area: Area | None = None,
    ) -> Array:
        """Premultiplied sRGB and alpha [H, W, 4] float32, of a part of the image where one is given."""
        self._canvas.begin(area)
        set_uniform(self._program, "matrix", tuple((camera.projection @ camera.view).T.ravel()))  # column by column
        self._context.enable_only(moderngl.DEPTH_TEST)
        for piece, at in zip(self._pieces, places, strict=True):
            self._draw(piece, at[piece.corners], solid=True)
        self._draw_clear(places, camera)
        return self._canvas.read(area)

    def near_first(
        self,
        places: Sequence[Array],  # as drawn
        camera: Camera,
        shown: Sequence[Array],  # for each part its triangles [F] bool that may be in an image
    ) -> None:
        """Draw what is near a camera before what it hides from now on, whose texture then need not be looked up.

        What is not `shown` is not drawn any more. Of triangles in one place the first of the file stays the first: they
        are ordered by slices of the depth.
        """
        depths = [_depths(at[piece.corners], camera) for piece, at in zip(self._pieces, places, strict=True)]
        thickness = max(float(np.ptp(np.concatenate(depths))) / SLICES, np.finfo(float).tiny)
        for piece, depth, held in zip(self._pieces, depths, shown, strict=True):
            order = np.argsort(-np.floor(depth / thickness), kind="stable")
            order = order[held[order]]
            piece.corners = piece.corners.reshape(-1, 3)[order].ravel()
            piece.inputs = piece.inputs.reshape(-1, 3, 6)[order].reshape(-1, 6)

    def _draw_clear(self, places: Sequence[Array], camera: Camera) -> None:
        """Draw transparent triangles over the rest, sorted from back to front."""
        self._context.enable(moderngl.BLEND)
        self._context.blend_func = LAID_OVER
        waiting = []
        for piece, at in zip(self._pieces, places, strict=True):
            if piece.clear:
                corners = at[piece.corners]
                depth = _depths(corners, camera)
                waiting.append((float(depth.mean()), piece, corners, np.argsort(depth, kind="stable")))
        for _, piece, corners, order in sorted(waiting, key=lambda entry: entry[0]):
            self._draw(piece, corners, (order[:, None] * 3 + np.arange(3)).ravel(), solid=False)

    def _draw(self, piece: _Piece, corners: Array, order: Array | None = None, *, solid: bool) -> None:
        material = self._materials[piece.material]
        self._textures[piece.material].use()
        set_uniform(self._program, "mirrored", (material.wrap_u == "mirror", material.wrap_v == "mirror"))
        set_uniform(self._program, "solid", solid)
        set_uniform(self._program, "cutoff", material.alpha_cutoff if piece.material in self._cut_late else 0.0)
        rows = np.concatenate([corners, piece.inputs], axis=1, dtype=np.float32)
        if order is not None:
            rows = rows[order]
        draw(self._program, rows, "3f 2f 4f", ("place", "coordinates", "factor"), mode=moderngl.TRIANGLES)


def _depths(corners: Array, camera: Camera) -> Array:
    """How near triangles [F] of corners [3 F, 3] are to a camera, from any one plane across its view."""
    return np.asarray((corners @ camera.view[2, :3]).reshape(-1, 3).mean(axis=1))


def _piece(part: Part, material: Material) -> _Piece:
    corners = part.faces.ravel()
    inputs = np.ones((len(corners), 6), np.float32)
    mapped = part.uv_faces.ravel() >= 0
    inputs[:, :2] = 0
    inputs[mapped, :2] = part.uv[part.uv_faces.ravel()[mapped]]
    if part.colors is not None:
        inputs[:, 2:] = part.colors.reshape(-1, 4)
    clear = material.image[..., 3].min() * inputs[:, 5].min(initial=1) < 255 * SOLID
    return _Piece(corners, inputs, part.material, bool(clear))


def _is_thinned(part: Part, material: Material) -> bool:
    """Whether the vertices of a mask change what of it is cut away."""
    return material.alpha_mode == "mask" and part.colors is not None and bool(part.colors[..., 3].min(initial=1) < 1)


def _is_palette(part: Part) -> bool:
    """Whether triangles have all their corners at one place of the texture.

    Filtering along a slant has no direction there, and drivers then blend places far apart.
    """
    mapped = part.uv_faces[(part.uv_faces >= 0).all(axis=1)]
    return bool((np.ptp(part.uv[mapped], axis=1) == 0).all(axis=1).any())


def _texture(context: moderngl.Context, material: Material, *, slanted: bool, cut: bool) -> moderngl.Texture:
    image = cut_out(material, EDGE) if material.alpha_mode == "mask" and cut else bled(material.image)
    factor = -(-max(image.shape[:2]) // LARGEST)
    if factor > 1:
        image = np.asarray(Image.fromarray(image).reduce(factor))
    texture = context.texture((image.shape[1], image.shape[0]), 4, np.ascontiguousarray(image).tobytes())
    texture.repeat_x, texture.repeat_y = material.wrap_u == "repeat", material.wrap_v == "repeat"
    texture.build_mipmaps()
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    texture.anisotropy = FILTERING if slanted else 1.0
    return texture
