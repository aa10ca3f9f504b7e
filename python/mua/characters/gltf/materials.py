"""Base colour of glTF materials: picture, factor, opacity, glow, and what they read of a mesh's vertices."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.atlas import pictures
from mua.characters.gltf.document import Document
from mua.characters.gltf.ktx2 import decode_ktx2, is_ktx2
from mua.characters.gltf.vrm import is_toon
from mua.characters.messages import Messages
from mua.scene import AlphaMode, Material, Wrap

WRAPS: dict[int, Wrap] = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
NEAREST = 9728  # of a sampler that shows texels as squares
ALPHA_MODES: dict[str, AlphaMode] = {"OPAQUE": "opaque", "MASK": "mask", "BLEND": "blend"}
REPEAT: tuple[Wrap, Wrap] = ("repeat", "repeat")
WEBP = "EXT_texture_webp"
AVIF = "EXT_texture_avif"
TRANSFORM = "KHR_texture_transform"
BASIS = "KHR_texture_basisu"
SPECULAR = "KHR_materials_pbrSpecularGlossiness"
STRENGTH = "KHR_materials_emissive_strength"
UNLIT = "KHR_materials_unlit"
TRANSMISSION = "KHR_materials_transmission"
VARIANTS = "KHR_materials_variants"


@dataclass(frozen=True, eq=False)
class Coordinates:
    """What a material reads of a mesh's vertices: which TEXCOORD set, moved how, and their colours."""

    texcoord: int = 0
    matrix: Array = field(default_factory=lambda: np.eye(2, 3))  # affine map of (u, v, 1)
    needed: bool = False  # there is a picture, which they place
    vertex_colors: bool = True  # COLOR_0 is multiplied in

    def apply(self, uv: Array) -> Array:
        """Move texture coordinates [T, 2]."""
        return np.asarray(uv @ self.matrix[:, :2].T + self.matrix[:, 2])

    def agrees(self, other: "Coordinates") -> bool:
        """Whether another texture lies at the same place of the surface."""
        return self.texcoord == other.texcoord and np.allclose(self.matrix, other.matrix)


def read_materials(document: Document, messages: Messages) -> tuple[tuple[Material, ...], tuple[Coordinates, ...]]:
    """All materials of a file, then one for primitives that name none; what is not drawn goes to `messages`."""
    materials = document.gltf.materials or []
    pairs = [_material(document, index, material, messages) for index, material in enumerate(materials)]
    pairs.append((Material("default", pictures.flat(np.ones(4)), alpha_mode="opaque"), Coordinates()))
    variants = (document.gltf.extensions or {}).get(VARIANTS, {}).get("variants")
    for variant in variants if isinstance(variants, list) else []:
        name = variant.get("name") if isinstance(variant, dict) else variant
        messages.add("The file's material variants are left out, its default is drawn: {}.", str(name))
    read, coordinates = zip(*pairs, strict=True)
    return read, coordinates


def _material(document: Document, index: int, material: Any, messages: Messages) -> tuple[Material, Coordinates]:
    where = f"materials[{index}]"
    factor, texture = _base_color(material)
    factor = np.asarray(factor, float)
    if factor.shape != (4,) or not np.isfinite(factor).all():
        raise document.error(f"{where} has the base colour factor {factor.tolist()}, expected four numbers")
    name = material.name or f"material{index}"
    if UNLIT in (material.extensions or {}) and not is_toon(material):
        messages.add("Unlit materials are shaded like the others: {}.", name)
    # A factor of 0 0 0 0 is one that nobody set; where alpha counts, its colour is never seen.
    tint = np.append(factor[:3] if factor.any() or material.alphaMode in (None, "OPAQUE") else np.ones(3), 1)
    image, wraps, reads = pictures.flat(tint), REPEAT, Coordinates()
    if texture is not None:
        image, wraps = _picture(document, texture, f"{where} base colour texture")
        image, reads = pictures.tinted(image, tint), _coordinates(document, texture, where)
    glow, glow_wraps, glow_reads = _emission(document, material, where)
    if glow is not None:
        if texture is None:
            wraps, reads = glow_wraps, glow_reads
        if not glow_reads.needed or (reads.agrees(glow_reads) and wraps == glow_wraps):
            image = pictures.glowing(image, glow)
        else:
            messages.add("Emission with another UV mapping than the base colour is left out, in materials: {}.", name)
    read = _with_alpha_mode(Material(name, image, *wraps, opacity=factor[3]), material, document, where)
    if read.alpha_mode != "mask":
        read = _with_transmission(read, reads, material, document, where, messages)
    return read, replace(reads, vertex_colors=not is_toon(material))


def _emission(document: Document, material: Any, where: str) -> tuple[Array | None, tuple[Wrap, Wrap], Coordinates]:
    """The light that a material sends out by itself, as a picture [h, w, 4]; None where it sends none."""
    factor = np.asarray(material.emissiveFactor or [0, 0, 0], float)
    if factor.shape != (3,) or not np.isfinite(factor).all():
        raise document.error(f"{where}.emissiveFactor is {factor.tolist()}, expected three numbers")
    strength = ((material.extensions or {}).get(STRENGTH) or {}).get("emissiveStrength", 1)
    if not isinstance(strength, int | float) or not np.isfinite(strength):
        raise document.error(f"{where}.extensions.{STRENGTH}.emissiveStrength is {strength}, expected a number")
    factor = np.append(factor * strength, 1)
    if not factor[:3].any():
        return None, REPEAT, Coordinates()
    if material.emissiveTexture is None:
        return pictures.flat(factor), REPEAT, Coordinates()
    info = vars(material.emissiveTexture)
    image, wraps = _picture(document, info, f"{where} emissive texture")
    return pictures.tinted(image, factor), wraps, _coordinates(document, info, where)


def _with_alpha_mode(read: Material, material: Any, document: Document, where: str) -> Material:
    """The material with what its file says of its alpha."""
    mode = ALPHA_MODES.get(material.alphaMode or "OPAQUE")
    if mode is None:
        raise document.error(f"{where}.alphaMode is {material.alphaMode!r}, expected one of {', '.join(ALPHA_MODES)}")
    cutoff = 0.5 if material.alphaCutoff is None else material.alphaCutoff
    return replace(read, alpha_mode=mode, alpha_cutoff=float(cutoff))


def _with_transmission(
    read: Material, reads: Coordinates, material: Any, document: Document, where: str, messages: Messages
) -> Material:
    """The material clear where light passes through it: glass, and the cornea before an eye."""
    extension = (material.extensions or {}).get(TRANSMISSION) or {}
    factor, texture = extension.get("transmissionFactor", 0), extension.get("transmissionTexture")
    field = f"{where}.extensions.{TRANSMISSION}"
    if not isinstance(factor, int | float) or not 0 <= factor <= 1:
        raise document.error(f"{field}.transmissionFactor is {factor}, expected a number from 0 to 1")
    if not factor:
        return read
    share = np.ones((1, 1))
    if texture is not None:
        picture, wraps = _picture(document, texture, f"{field}.transmissionTexture")
        share = picture[..., 0] / 255
        here = reads.needed and reads.agrees(_coordinates(document, texture, where))
        if not here or wraps != (read.wrap_u, read.wrap_v):
            messages.add(
                "Transmission with another UV mapping than the base colour is left out, in materials: {}.", read.name
            )
            return read
    image = pictures.opaque(read.image) if read.alpha_mode == "opaque" else read.image
    opacity = 1.0 if read.alpha_mode == "opaque" else read.opacity
    image = pictures.transmitting(image, factor * share)
    return replace(read, image=image, opacity=opacity, alpha_mode="blend")


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
    for name in (AVIF, BASIS):  # a PNG beside them shows more
        if source is None:
            source = (texture.extensions or {}).get(name, {}).get("source")
    image = document.item("images", source, field=f"textures[{info['index']}].source")
    field = f"images[{source}]"
    if image.bufferView is not None:
        content = document.view(image.bufferView, field=f"{field}.bufferView")
    elif image.uri:
        content = document.resource(image.uri, field=f"{field}.uri")
    else:
        raise document.error(f"{field} has neither uri nor bufferView")
    try:
        picture = decode_ktx2(content) if is_ktx2(content) else pictures.decode_image(content)
    except ValueError as broken:
        raise document.error(
            f"{field} is not a PNG, JPEG, WebP, AVIF or KTX2 that can be decoded: {broken}"
        ) from broken
    if texture.sampler is None:
        return picture, REPEAT
    sampler = document.item("samplers", texture.sampler, field=f"textures[{info['index']}].sampler")
    if sampler.magFilter == NEAREST:
        picture = pictures.blocky(picture)
    return picture, (WRAPS.get(sampler.wrapS, "repeat"), WRAPS.get(sampler.wrapT, "repeat"))


def _coordinates(document: Document, info: dict[str, Any], where: str) -> Coordinates:
    texcoord = info.get("texCoord") or 0
    transform = (info.get("extensions") or {}).get(TRANSFORM)
    if transform is None:
        return Coordinates(texcoord, needed=True)
    try:
        (du, dv), (su, sv) = transform.get("offset", [0, 0]), transform.get("scale", [1, 1])
        angle = float(transform.get("rotation", 0))
        c, s = np.cos(angle), np.sin(angle)
        # counter-clockwise as seen, which with v down is the transpose of the usual rotation
        matrix = np.array([[c * su, s * sv, du], [-s * su, c * sv, dv]], float)
    except (TypeError, ValueError) as broken:
        raise document.error(f"{where} {TRANSFORM} holds {transform}, expected offset, rotation, scale") from broken
    return Coordinates(transform.get("texCoord", texcoord), matrix, needed=True)
