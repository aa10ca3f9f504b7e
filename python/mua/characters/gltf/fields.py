"""The JSON of a glTF file as objects of pygltflib: each field that is read is checked, absent ones are None.

pygltflib's own parser takes fields of any kind, and ten times as long for a file of many clips.
"""

from collections.abc import Mapping
from typing import Any, TypeAlias

import pygltflib

Kind: TypeAlias = "type | str | list[Kind]"  # a type, an object of FIELDS by its name, or an array of either

NUMBERS: list[Kind] = [float]
INDICES: list[Kind] = [int]

# What is read of each object (glTF 2.0, chapter 5). Fields that are not listed are not looked at.
FIELDS: dict[str, dict[str, Kind]] = {
    "glTF": {
        "scene": int,
        "scenes": ["scene"],
        "nodes": ["node"],
        "meshes": ["mesh"],
        "skins": ["skin"],
        "animations": ["animation"],
        "accessors": ["accessor"],
        "bufferViews": ["bufferView"],
        "buffers": ["buffer"],
        "materials": ["material"],
        "textures": ["texture"],
        "images": ["image"],
        "samplers": ["sampler"],
        "extensionsUsed": [str],
        "extensionsRequired": [str],
    },
    "scene": {"nodes": INDICES},
    "node": {
        "name": str,
        "mesh": int,
        "skin": int,
        "children": INDICES,
        "matrix": NUMBERS,
        "translation": NUMBERS,
        "rotation": NUMBERS,
        "scale": NUMBERS,
        "weights": NUMBERS,
    },
    "mesh": {"name": str, "primitives": ["primitive"], "weights": NUMBERS},
    "primitive": {
        "attributes": "attributes",
        "indices": int,
        "material": int,
        "mode": int,
        "targets": ["attributes"],
    },
    "skin": {"joints": INDICES, "inverseBindMatrices": int},
    "animation": {"name": str, "channels": ["channel"], "samplers": ["keys"]},
    "channel": {"sampler": int, "target": "target"},
    "target": {"node": int, "path": str},
    "keys": {"input": int, "output": int, "interpolation": str},
    "accessor": {
        "bufferView": int,
        "byteOffset": int,
        "componentType": int,
        "normalized": bool,
        "count": int,
        "type": str,
        "sparse": "sparse",
        "min": NUMBERS,
        "max": NUMBERS,
    },
    "sparse": {"count": int, "indices": "sparse part", "values": "sparse part"},
    "sparse part": {"bufferView": int, "byteOffset": int, "componentType": int},
    "bufferView": {"buffer": int, "byteOffset": int, "byteLength": int, "byteStride": int},
    "buffer": {"uri": str, "byteLength": int},
    "material": {
        "name": str,
        "alphaMode": str,
        "alphaCutoff": float,
        "emissiveFactor": NUMBERS,
        "emissiveTexture": "textureInfo",
        "pbrMetallicRoughness": "pbrMetallicRoughness",
    },
    "pbrMetallicRoughness": {"baseColorFactor": NUMBERS, "baseColorTexture": "textureInfo"},
    "textureInfo": {"index": int, "texCoord": int},
    "texture": {"source": int, "sampler": int},
    "image": {"uri": str, "bufferView": int},
    "sampler": {"wrapS": int, "wrapT": int, "magFilter": int},
}
STRUCTURES: dict[str, type] = {
    "glTF": pygltflib.GLTF2,
    "scene": pygltflib.Scene,
    "node": pygltflib.Node,
    "mesh": pygltflib.Mesh,
    "primitive": pygltflib.Primitive,
    "skin": pygltflib.Skin,
    "animation": pygltflib.Animation,
    "channel": pygltflib.AnimationChannel,
    "target": pygltflib.AnimationChannelTarget,
    "keys": pygltflib.AnimationSampler,
    "accessor": pygltflib.Accessor,
    "sparse": pygltflib.Sparse,
    "sparse part": pygltflib.AccessorSparseIndices,
    "bufferView": pygltflib.BufferView,
    "buffer": pygltflib.Buffer,
    "material": pygltflib.Material,
    "pbrMetallicRoughness": pygltflib.PbrMetallicRoughness,
    "textureInfo": pygltflib.TextureInfo,
    "texture": pygltflib.Texture,
    "image": pygltflib.Image,
    "sampler": pygltflib.Sampler,
}
ATTRIBUTES, EXTENSIONS = "attributes", "extensions"  # objects whose names are free: of indices, and of objects
WORDS = {int: "a whole number", float: "a number", str: "a string", bool: "true or false", dict: "an object"}


class Names:
    """An object of the JSON whose names are free, as attributes; what it does not have is None."""

    def __init__(self, fields: Mapping[str, Any]) -> None:
        self.__dict__.update(fields)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return None


def read_object(raw: Any, kind: str = "glTF", where: str = "") -> Any:
    """The object `raw` of a kind of FIELDS; raises ValueError that names the field which is of another kind.

    Extensions stay dictionaries of dictionaries: whoever reads one checks what is in it.
    """
    if not isinstance(raw, dict):
        raise ValueError(f"{where} is {_short(raw)}, expected an object")
    free = {ATTRIBUTES: int, EXTENSIONS: dict}
    known = dict.fromkeys(raw, free[kind]) if kind in free else FIELDS[kind] | {"extensions": EXTENSIONS}
    fields = {
        name: _value(raw[name], wanted, f"{where}.{name}" if where else name)
        for name, wanted in known.items()
        if raw.get(name) is not None
    }
    if kind in free:
        return Names(fields)
    found = STRUCTURES[kind]()
    vars(found).update(dict.fromkeys(vars(found)) | dict.fromkeys(known) | fields)
    return found


def _value(raw: Any, kind: Kind, where: str) -> Any:
    if isinstance(kind, list):
        if not isinstance(raw, list):
            raise ValueError(f"{where} is {_short(raw)}, expected an array")
        return [_value(item, kind[0], f"{where}[{index}]") for index, item in enumerate(raw)]
    if isinstance(kind, str):
        found = read_object(raw, kind, where)
        return vars(found) if kind == EXTENSIONS else found
    if kind is int and isinstance(raw, float) and raw.is_integer():  # some exporters write 3.0 for 3
        return int(raw)
    accepted = (int, float) if kind is float else kind
    if not isinstance(raw, accepted) or (isinstance(raw, bool) and kind is not bool):
        raise ValueError(f"{where} is {_short(raw)}, expected {WORDS[kind]}")
    return raw


def _short(raw: Any) -> str:
    text = str(raw)
    return text if len(text) <= 60 else f"{text[:57]}..."
