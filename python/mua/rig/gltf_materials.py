"""Base colour of glTF materials: picture, factor, opacity and the texture coordinates that they ask for."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.rig import pictures
from mua.rig.gltf_document import Document
from mua.rig.scene import Material, Wrap

WRAPS: dict[int, Wrap] = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
WEBP = "EXT_texture_webp"
TRANSFORM = "KHR_texture_transform"
SPECULAR = "KHR_materials_pbrSpecularGlossiness"


@dataclass(frozen=True)
class Coordinates:
    """Which TEXCOORD set a material reads and how it moves it."""

    texcoord: int = 0
    matrix: Array | None = None  # [2, 3] affine map of (u, v, 1); None leaves them as they are

    def apply(self, uv: Array) -> Array:
        """Move texture coordinates [T, 2]."""
        return uv if self.matrix is None else uv @ self.matrix[:, :2].T + self.matrix[:, 2]


def read_materials(document: Document) -> tuple[tuple[Material, ...], tuple[Coordinates, ...]]:
    """All materials of a file, then one for primitives that name none."""
    pairs = [_material(document, index, material) for index, material in enumerate(document.gltf.materials or [])]
    pairs.append((Material("default", pictures.flat(np.ones(4))), Coordinates()))
    materials, coordinates = zip(*pairs, strict=True)
    return materials, coordinates


def _material(document: Document, index: int, material: Any) -> tuple[Material, Coordinates]:
    where = f"materials[{index}]"
    factor, texture = _base_color(material)
    factor = np.asarray(factor, float)
    if factor.shape != (4,) or not np.isfinite(factor).all():
        raise document.error(f"{where} has the base colour factor {factor.tolist()}, expected four numbers")
    name = material.name or f"material{index}"
    opaque = (material.alphaMode or "OPAQUE") == "OPAQUE"
    if texture is None:
        image = pictures.flat(factor)
        return Material(name, pictures.opaque(image) if opaque else image), Coordinates()
    image, wraps = _picture(document, texture, f"{where} base colour texture")
    image = pictures.tinted(image, factor)
    return Material(name, pictures.opaque(image) if opaque else image, *wraps), _coordinates(document, texture, where)


def _base_color(material: Any) -> tuple[Any, dict[str, Any] | None]:
    """Factor and texture info of either material model that glTF files carry."""
    specular = (material.extensions or {}).get(SPECULAR)
    if specular is not None:
        return specular.get("diffuseFactor", [1, 1, 1, 1]), specular.get("diffuseTexture")
    model = material.pbrMetallicRoughness
    if model is None:
        return [1, 1, 1, 1], None
    texture = model.baseColorTexture
    return model.baseColorFactor or [1, 1, 1, 1], None if texture is None else vars(texture)


def _picture(document: Document, info: dict[str, Any], where: str) -> tuple[Array, tuple[Wrap, Wrap]]:
    texture = document.item("textures", info.get("index"), field=f"{where}.index")
    source = (texture.extensions or {}).get(WEBP, {}).get("source", texture.source)
    image = document.item("images", source, field=f"textures[{info['index']}].source")
    field = f"images[{source}]"
    if image.bufferView is not None:
        content = document.view(image.bufferView, field=f"{field}.bufferView")
    elif image.uri:
        content = document.resource(image.uri, field=f"{field}.uri")
    else:
        raise document.error(f"{field} has neither uri nor bufferView")
    try:
        picture = pictures.decode_image(content)
    except ValueError as broken:
        raise document.error(f"{field} is not a PNG, JPEG or WebP that can be decoded: {broken}") from broken
    if texture.sampler is None:
        return picture, ("repeat", "repeat")
    sampler = document.item("samplers", texture.sampler, field=f"textures[{info['index']}].sampler")
    return picture, (WRAPS.get(sampler.wrapS, "repeat"), WRAPS.get(sampler.wrapT, "repeat"))


def _coordinates(document: Document, info: dict[str, Any], where: str) -> Coordinates:
    texcoord = info.get("texCoord") or 0
    transform = (info.get("extensions") or {}).get(TRANSFORM)
    if transform is None:
        return Coordinates(texcoord)
    try:
        (du, dv), (su, sv) = transform.get("offset", [0, 0]), transform.get("scale", [1, 1])
        angle = float(transform.get("rotation", 0))
        c, s = np.cos(angle), np.sin(angle)
        # counter-clockwise as seen, which with v down is the transpose of the usual rotation
        matrix = np.array([[c * su, s * sv, du], [-s * su, c * sv, dv]], float)
    except (TypeError, ValueError) as broken:
        raise document.error(f"{where} {TRANSFORM} holds {transform}, expected offset, rotation, scale") from broken
    return Coordinates(transform.get("texCoord", texcoord), matrix)
