"""The JSON of a glTF file: whatever stands in its fields, a character is read or one sentence names what is wrong."""

import copy
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import HALF_TURN, PICTURE, animate, primitive, textured

from mua.characters.gltf.fields import read_object
from mua.characters.read import read_surfaces
from mua.errors import InputError

WRONG: list[Any] = ["x", -1, 10**9, 1.5, True, {}, [], [{}], [[0.5]], {"index": 0}, float("nan")]


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Every place inside a JSON value."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield (*path, key)
        yield from places(item, (*path, key))


def rich() -> Any:
    """A character with an image, morph targets, clips, glow and a VRM's bones."""
    glb = textured(PICTURE, emissiveFactor=[1, 1, 1], emissiveTexture={"index": 0}, alphaMode="MASK", alphaCutoff=0.4)
    primitive(glb)["targets"] = [{"POSITION": glb.accessor(np.ones((16, 3)))}]
    glb.json["meshes"][0]["weights"] = [0.5]
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    animate(glb, 3, "weights", times=[0.0, 1.0], values=[0.0, 1.0])
    bones = [{"bone": "hips", "node": 0}, {"bone": "spine", "node": 1}]
    first = {"meshAnnotations": [{"mesh": 0, "firstPersonFlag": "Auto"}]}
    meta = {"title": "A", "author": "B", "licenseName": "CC0"}
    springs: dict[str, Any] = {"boneGroups": [{}]}
    glb.json["extensions"] = {
        "VRM": {"humanoid": {"humanBones": bones}, "firstPerson": first, "meta": meta, "secondaryAnimation": springs},
        "KHR_materials_variants": {"variants": [{"name": "night"}]},
    }
    info = glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    info["extensions"] = {"KHR_texture_transform": {"offset": [0, 0], "scale": [1, 1], "rotation": 0.0}}
    glb.json["materials"][0]["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
    glb.json["nodes"][2]["extensions"] = {"KHR_node_visibility": {"visible": True}}
    return glb


def test_nothing_but_one_sentence_comes_of_a_wrong_field(tmp_path: Path) -> None:
    glb = rich()
    read_surfaces(glb.save(tmp_path / "body.glb"))
    whole = json.loads(json.dumps(glb.json))
    sentences = []
    path = tmp_path / "wrong.glb"
    for number, place in enumerate(places(whole)):
        glb.json = copy.deepcopy(whole)
        holder = glb.json
        for key in place[:-1]:
            holder = holder[key]
        for wrong in (WRONG[number % len(WRONG)], WRONG[(3 * number + 5) % len(WRONG)]):
            holder[place[-1]] = wrong
            glb.save(path)
            try:
                read_surfaces(path)
            except InputError as refusal:
                sentences.append(str(refusal))
            except Exception as escaped:
                raise AssertionError(f"{place} = {wrong} ends in {escaped!r}") from escaped
    assert len(sentences) > 100
    assert all(sentence.startswith(str(path)) for sentence in sentences)


@pytest.mark.parametrize(
    ("raw", "sentence"),
    [
        ({"nodes": 7}, "nodes is 7, expected an array"),
        ({"nodes": [3]}, r"nodes\[0\] is 3, expected an object"),
        ({"nodes": [{"mesh": "a"}]}, r"nodes\[0\]\.mesh is a, expected a whole number"),
        ({"nodes": [{"mesh": True}]}, r"nodes\[0\]\.mesh is True, expected a whole number"),
        ({"nodes": [{"scale": [1, None, 1]}]}, r"nodes\[0\]\.scale\[1\] is None, expected a number"),
        ({"meshes": [{"primitives": [{"attributes": {"POSITION": []}}]}]}, r"attributes\.POSITION is \[\]"),
        ({"materials": [{"extensions": []}]}, r"materials\[0\]\.extensions is \[\], expected an object"),
    ],
)
def test_field_of_another_kind_is_named(raw: Any, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        read_object(raw)


def test_absent_fields_are_none_and_whole_floats_are_whole() -> None:
    found = read_object({"nodes": [{"mesh": 3.0, "name": None}]})
    assert (found.nodes[0].mesh, found.nodes[0].name, found.scene) == (3, None, None)
