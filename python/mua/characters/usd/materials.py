"""Base colour and glow of USD materials: UsdPreviewSurface with UsdUVTexture or a primvar, or displayColor.

UsdPreviewSurface specification (https://openusd.org/release/spec_usdpreviewsurface.html). Image rows are kept as in
glTF; texture coordinates, whose v points up in USD, are turned by whoever reads them.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Ar, Sdf, Usd, UsdGeom, UsdShade

from mua.arrays import Array
from mua.atlas import pictures
from mua.characters.alpha import with_stated_opacity
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.scene import Material, Wrap

WRAPS: dict[str, Wrap] = {"repeat": "repeat", "mirror": "mirror", "clamp": "clamp", "black": "clamp"}
PRIMVARS = {"UsdPrimvarReader_float3": "displayColor", "UsdPrimvarReader_float": "displayOpacity"}
CHANNELS = {"r": 0, "g": 1, "b": 2, "a": 3}


@dataclass(frozen=True, eq=False)
class Look:
    """A material, the primvar of its texture coordinates, and the affine map [2, 3] on them (v up)."""

    material: Material
    primvar: str | None = None
    matrix: Array = field(default_factory=lambda: np.eye(2, 3))
    needed: bool = False  # there is an image, which the coordinates place
    color_primvar: str | None = None  # of the mesh, multiplied in
    opacity_primvar: str | None = None


def read_look(mesh: UsdGeom.Mesh, prim: Usd.Prim, path: Path, messages: Messages) -> Look:
    """The look of a mesh or of one of its subsets `prim`; what is not drawn goes to `messages`."""
    material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
    shader = material.ComputeSurfaceSource()[0] if material else None
    if not shader:
        return _display_look(mesh, prim)
    look = _surface_look(material.GetPrim().GetName(), shader, path)
    glow, source = _value(shader, "emissiveColor", default=(0, 0, 0))
    if source is None:
        picture = pictures.flat(np.array([*glow, 1]))
    else:
        textured = _textured(look.material.name, source[0], path)
        picture = textured.material.image
        if not look.needed:
            look = _at(look, textured)
        elif not _same_place(look, textured):
            sentence = "Emission with another UV mapping than the base colour is left out, in materials: {}."
            messages.add(sentence, look.material.name)
            return look
    if not picture[..., :3].any():
        return look
    return replace(look, material=replace(look.material, image=pictures.glowing(look.material.image, picture)))


def _same_place(look: Look, other: Look) -> bool:
    """Whether two textures lie at the same place of the surface."""
    wraps = [(one.material.wrap_u, one.material.wrap_v) for one in (look, other)]
    return look.primvar == other.primvar and wraps[0] == wraps[1] and np.allclose(look.matrix, other.matrix)


def _surface_look(name: str, shader: UsdShade.Shader, path: Path) -> Look:
    """Diffuse colour and opacity of a UsdPreviewSurface."""
    color, source = _value(shader, "diffuseColor", default=(0.18, 0.18, 0.18))
    if source is not None:
        look = _textured(name, source[0], path)
    elif isinstance(color, str):
        look = Look(Material(name, pictures.flat(np.ones(4))), color_primvar=color)
    else:
        look = Look(Material(name, pictures.flat(np.array([*color, 1]))))
    threshold = float(_value(shader, "opacityThreshold", default=0.0)[0])
    if threshold > 0:
        look = replace(look, material=replace(look.material, alpha_mode="mask", alpha_cutoff=threshold))
    return _with_opacity(look, shader, path)


def _with_opacity(look: Look, shader: UsdShade.Shader, path: Path) -> Look:
    """The look with its opacity: of a channel of a texture, of the mesh, or a number."""
    opacity, source = _value(shader, "opacity", default=1.0)
    if source is not None:
        image = pictures.with_opacity(look.material.image, _channel(*source, path))
        placed = look if look.needed else _at(look, _textured(look.material.name, source[0], path))
        return replace(placed, material=replace(placed.material, image=image))
    if isinstance(opacity, str):
        image = pictures.opaque(look.material.image)
        return replace(look, material=replace(look.material, image=image), opacity_primvar=opacity)
    return replace(look, material=with_stated_opacity(look.material, float(opacity)))


def _at(look: Look, other: Look) -> Look:
    """The look at the place of the surface where another lies."""
    material = replace(look.material, wrap_u=other.material.wrap_u, wrap_v=other.material.wrap_v)
    return replace(look, material=material, primvar=other.primvar, matrix=other.matrix, needed=True)


def _display_look(mesh: UsdGeom.Mesh, prim: Usd.Prim) -> Look:
    """The look of a mesh without a material: its displayColor and displayOpacity, constant or over the surface."""
    color, opacity = UsdGeom.PrimvarsAPI(mesh), mesh.GetDisplayOpacityPrimvar()
    found = color.FindPrimvarWithInheritance("displayColor")
    values = np.array(found.ComputeFlattened(Usd.TimeCode.EarliestTime()) if found and found.HasValue() else [], float)
    varies = len(values) > 1
    flat = [1, 1, 1] if varies else values.reshape(-1, 3)[0] if len(values) else [0.5, 0.5, 0.5]
    return Look(
        Material(prim.GetName(), pictures.flat(np.array([*flat, 1.0]))),
        color_primvar="displayColor" if varies else None,
        opacity_primvar="displayOpacity" if opacity and opacity.HasValue() else None,
    )


def _value(shader: UsdShade.Shader, name: str, *, default: Any) -> tuple[Any, tuple[UsdShade.Shader, str] | None]:
    """An input's constant or, as a string, the primvar that it reads; and the texture (with its output), if any."""
    given = shader.GetInput(name)
    if not given:
        return default, None
    for attribute in UsdShade.Utils.GetValueProducingAttributes(given):
        producer = UsdShade.Shader(attribute.GetPrim())
        if producer and producer.GetIdAttr().Get() == "UsdUVTexture":
            return default, (producer, attribute.GetBaseName())
        if producer and producer.GetIdAttr().Get() in PRIMVARS:
            return str(_constant(producer, "varname", PRIMVARS[producer.GetIdAttr().Get()])), None
        constant = attribute.Get(Usd.TimeCode.EarliestTime())
        if constant is not None:
            return constant, None
    return default, None


def _textured(name: str, texture: UsdShade.Shader, path: Path) -> Look:
    image = _picture(texture, path)
    if _constant(texture, "sourceColorSpace", "auto") == "raw":
        image = pictures.from_linear(image)
    image = pictures.tinted(image, _scale(texture))
    wraps = [WRAPS.get(_constant(texture, wrap, "repeat"), "repeat") for wrap in ("wrapS", "wrapT")]
    reader = _source(texture, "st")
    matrix = np.eye(2, 3)
    if reader is not None and reader.GetIdAttr().Get() == "UsdTransform2d":
        angle = np.radians(_constant(reader, "rotation", 0.0))
        (su, sv), (du, dv) = _constant(reader, "scale", (1, 1)), _constant(reader, "translation", (0, 0))
        c, s = np.cos(angle), np.sin(angle)
        matrix = np.array([[c * su, -s * sv, du], [s * su, c * sv, dv]])
        reader = _source(reader, "in")
    primvar = None if reader is None else str(_constant(reader, "varname", "st"))
    return Look(Material(name, image, wraps[0], wraps[1]), primvar, matrix, needed=True)


def _channel(texture: UsdShade.Shader, output: str, path: Path) -> Array:
    """One channel [h, w] of a UsdUVTexture with its scale: a share, which no colour space applies to."""
    channel = CHANNELS[output]
    return np.round(np.minimum(_picture(texture, path)[..., channel] * _scale(texture)[channel], 255)).astype(np.uint8)


def _scale(texture: UsdShade.Shader) -> Array:
    """The linear factors [4] of a texture."""
    return np.array(_constant(texture, "scale", (1, 1, 1, 1)), float)


def _source(shader: UsdShade.Shader, name: str) -> UsdShade.Shader | None:
    given = shader.GetInput(name)
    for attribute in UsdShade.Utils.GetValueProducingAttributes(given) if given else []:
        source = UsdShade.Shader(attribute.GetPrim())
        if source:
            return source
    return None


def _constant(shader: UsdShade.Shader, name: str, default: Any) -> Any:
    given = shader.GetInput(name)
    for attribute in UsdShade.Utils.GetValueProducingAttributes(given) if given else []:
        value = attribute.Get(Usd.TimeCode.EarliestTime())
        if value is not None:
            return value
    return default


def _picture(texture: UsdShade.Shader, path: Path) -> Array:
    """The image [h, w, 4] of a UsdUVTexture as it is stored, from beside the stage or inside its package."""
    field = f"{texture.GetPath()}.inputs:file"
    asset = _constant(texture, "file", None)
    if not isinstance(asset, Sdf.AssetPath) or not asset.resolvedPath:
        raise InputError(f"{path}: {field} names {getattr(asset, 'path', asset)}, which cannot be found")
    opened = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(asset.resolvedPath))
    if not opened:
        raise InputError(f"{path}: {field} names {asset.path}, which cannot be read")
    with opened:
        content = bytes(opened.GetBuffer())
    try:
        return pictures.decode_image(content)
    except ValueError as broken:
        raise InputError(f"{path}: {field} names {asset.path}, which cannot be decoded: {broken}") from broken
