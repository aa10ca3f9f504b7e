"""Base colour, opacity and glow of FBX materials: Lambert, Phong, and the physically based ones that ufbx knows."""

import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import ufbx

from mua.arrays import Array
from mua.atlas import pictures
from mua.characters.alpha import with_stated_opacity
from mua.characters.fbx.bindings import get, items
from mua.characters.fbx.textures import file_name, read_picture
from mua.characters.messages import LOST, Messages
from mua.scene import Material, Wrap

WRAPS: dict[int, Wrap] = {int(ufbx.WrapMode.REPEAT): "repeat", int(ufbx.WrapMode.CLAMP): "clamp"}
OPACITY = ("pbr.opacity", "fbx.transparency_color", "fbx.transparency_factor")  # properties with a picture of it
BASE = re.compile("^(?!.*cube).*(diffuse|albedo|base_?colou?r|main_?tex)", re.IGNORECASE)  # a cube is of the light
GREY = np.array([0.6, 0.6, 0.6, 1.0])  # linear colour of a material that states none
DEFAULT = Material("default", pictures.flat(GREY), alpha_mode="opaque")  # of faces without a material


@dataclass(frozen=True, eq=False)
class Look:
    """A material, and which texture coordinates of a mesh it reads, moved how."""

    material: Material
    uv_set: str = ""
    matrix: Array = field(default_factory=lambda: np.eye(2, 3))  # affine map of (u, v, 1), v up
    needed: bool = False  # there is a picture, which they place


class Looks:
    """The materials of a file that its meshes ask for."""

    def __init__(self, scene: Any, path: Path, messages: Messages) -> None:
        self._path, self._messages = path, messages
        author = f"{get(scene, 'metadata.creator')} {get(scene, 'metadata.original_application.name')}"
        self._linear = "blender" in author.lower()  # which writes the linear values that it works with; others, sRGB
        self._found: dict[int, int] = {}  # element to index
        self.read: list[Look] = []

    def index(self, source: Any | None) -> int:
        """The index of a material in `read`; None is the default of faces without one."""
        element = -1 if source is None else int(get(source, "element_id"))
        if element not in self._found:
            self._found[element] = len(self.read)
            self.read.append(Look(DEFAULT) if source is None else self._look(source))
        return self._found[element]

    def _look(self, source: Any) -> Look:
        name = str(get(source, "name"))
        base = _texture(source, "pbr.base_color") or _texture(source, "fbx.diffuse_color")
        texture, picture = self._picture(base or _unknown_base(source))
        if texture is None or picture is None:
            look = Look(Material(name, pictures.flat(self._color(source, "pbr.base_color", "pbr.base_factor"))))
        else:
            look = _placed(Material(name, picture), texture)
        look = self._with_opacity(look, source, own=base is None and texture is not None)
        glow = self._glow(source)
        if glow is None:
            return look
        return replace(look, material=replace(look.material, image=pictures.glowing(look.material.image, glow)))

    def _color(self, source: Any, color: str, factor: str) -> Array:
        """A colour of a material times its factor, linear and opaque [4]; a factor of 0 is one that nobody set."""
        if not get(source, f"{color}.has_value"):
            return GREY
        value = np.nan_to_num(np.array(get(source, f"{color}.value_vec4"), float)[:3])
        times = float(get(source, f"{factor}.value_vec4")[0])
        shown = np.clip(value * (times if np.isfinite(times) and times > 0 else 1.0), 0, 1)
        if not self._linear:
            shown = np.interp(shown * 255, np.arange(256), pictures.LINEAR)
        return np.append(shown, 1.0)

    def _picture(self, texture: Any | None) -> tuple[Any | None, Array | None]:
        """The file of a texture and its picture; a lost one is noted."""
        if texture is None:
            return None, None
        files = list(items(texture, "file_textures"))
        texture = files[0] if files else texture
        picture = read_picture(texture, self._path)
        if picture is None:
            self._messages.add(LOST, file_name(texture))
        return texture, picture

    def _glow(self, source: Any) -> Array | None:
        """The light that a material sends out by itself, as a picture [h, w, 4]; None where it sends none."""
        _, picture = self._picture(_texture(source, "pbr.emission_color"))
        factor = float(get(source, "pbr.emission_factor.value_vec4")[0])
        if picture is not None:
            return pictures.tinted(picture, np.append(np.full(3, min(max(factor, 0.0), 1.0)), 1))
        if not factor > 0 or not get(source, "pbr.emission_color.has_value"):
            return None
        color = self._color(source, "pbr.emission_color", "pbr.emission_factor")
        return pictures.flat(color) if color[:3].any() else None

    def _with_opacity(self, look: Look, source: Any, *, own: bool) -> Look:
        """The look with its opacity: a picture's, else a number; without either it is opaque, whatever its alpha.

        With `own`, of a shader that ufbx does not know, the alpha of the base colour counts.
        """
        if own and (look.material.image[..., 3] < 255).any():
            return look
        found = (_texture(source, name) for name in OPACITY)
        texture, picture = self._picture(next((one for one in found if one is not None), None))
        if texture is not None and picture is not None:
            image = pictures.with_opacity(look.material.image, _opacity(picture))
            placed = look if look.needed else _placed(look.material, texture)
            return replace(placed, material=replace(placed.material, image=image))
        return replace(look, material=with_stated_opacity(look.material, _stated_opacity(source)))


def _texture(source: Any, name: str) -> Any | None:
    """The texture of a property, None where it has none or it is switched off."""
    return get(source, f"{name}.texture") if get(source, f"{name}.texture_enabled") else None


def _unknown_base(source: Any) -> Any | None:
    """The texture of a shader that ufbx does not know whose property is called as one of the base colour."""
    for texture in items(source, "textures"):
        if BASE.match(str(get(texture, "material_prop"))):
            return get(texture, "texture")
    return None


def _stated_opacity(source: Any) -> float:
    """The opacity that a material states, 0..1: itself, or as how transparent its colour and factor make it."""
    if get(source, "pbr.opacity.has_value"):
        opacity = float(get(source, "pbr.opacity.value_vec4")[0])
    elif get(source, "fbx.transparency_color.has_value"):
        factor = get(source, "fbx.transparency_factor")
        times = float(get(factor, "value_vec4")[0]) if get(factor, "has_value") else 1.0
        opacity = 1 - times * float(np.mean(get(source, "fbx.transparency_color.value_vec4")[:3]))
    else:
        opacity = 1.0
    return min(max(opacity, 0.0), 1.0) if np.isfinite(opacity) else 1.0


def _opacity(picture: Array) -> Array:
    """The opacity [h, w] in a picture [h, w, 4]: its alpha, else its brightness where it has none."""
    return picture[..., 3] if (picture[..., 3] < 255).any() else picture[..., :3].max(axis=2)


def _placed(material: Material, texture: Any) -> Look:
    """The look of a texture at its place on the surface."""
    wraps = [WRAPS.get(int(get(texture, name)), "repeat") for name in ("wrap_u", "wrap_v")]
    matrix = np.eye(2, 3)
    if get(texture, "has_uv_transform"):
        columns = np.array(get(texture, "uv_to_texture"), float)
        matrix = np.stack([columns[0, :2], columns[1, :2], columns[3, :2]], axis=1)
    material = replace(material, wrap_u=wraps[0], wrap_v=wraps[1])
    return Look(material, str(get(texture, "uv_set")), matrix, needed=True)
