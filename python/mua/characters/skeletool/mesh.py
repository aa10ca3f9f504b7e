"""A character's mesh and texture: Wavefront .obj with its .mtl, of triangles or larger faces."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.atlas import pictures
from mua.characters.skeletool.lines import SHOWN, read_lines
from mua.errors import InputError
from mua.scene import Material

GREY = np.array([0.5, 0.5, 0.5, 1.0])  # linear colour of a mesh without a material


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles; positions in the units of the file."""

    positions: Array  # [V, 3]
    uv: Array  # [T, 2] v down
    faces: Array  # [F, 3] int into positions
    uv_faces: Array  # [F, 3] int into uv, -1 where there are none
    face_material: Array  # [F] int into materials
    materials: tuple[Material, ...]


class _Obj:
    """The content of a .obj, as it is read.

    trimesh would part vertices along UV seams, 5,514 into 5,964 of DDC's person, for which skin weights count them.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.positions: list[list[float]] = []
        self.uv: list[list[float]] = []
        self.corners: list[list[tuple[int, int]]] = []  # of triangles: position and UV
        self.libraries: list[Path] = []  # of materials
        self.used: list[str] = []  # material of each triangle
        self.material = ""

    def read(self, words: list[str]) -> None:
        """Take in a line; raises ValueError where it is not as it should be."""
        match words[0]:
            case "v":
                self.positions.append(_finite(words[1:], 3))
            case "vt":
                self.uv.append(_finite(words[1:], 2))
            case "f":
                ring = [self._corner(word) for word in words[1:]]
                self.corners += [[ring[0], ring[k], ring[k + 1]] for k in range(1, len(ring) - 1)]
                self.used += [self.material] * (len(ring) - 2)
            case "usemtl":
                self.material = " ".join(words[1:])
            case "mtllib":
                self.libraries.append(self.path.parent / " ".join(words[1:]))

    def _corner(self, word: str) -> tuple[int, int]:
        """Position and UV of a corner, from 0; -1 where it has no UV."""
        position, uv, *_ = [*word.split("/"), ""]
        return _index(position, len(self.positions)), _index(uv, len(self.uv)) if uv else -1


def read_mesh(path: Path) -> Mesh:
    """Read a .obj and the images of its materials; raises InputError that names file and line."""
    found = _Obj(path)
    for number, text in enumerate(read_lines(path), 1):
        try:
            if words := text.split():
                found.read(words)
        except ValueError:
            raise InputError(f"{path}, line {number}: {text[:SHOWN]!r} is no line of a .obj file") from None
    if not found.corners:
        raise InputError(f"{path}: holds no triangles")
    names = list(dict.fromkeys(found.used))
    looks = {name: picture for library in found.libraries for name, picture in _pictures(library).items()}
    corners = np.array(found.corners)
    without_uv = np.any(corners[..., 1] < 0, axis=1, keepdims=True)
    uv = np.array(found.uv).reshape(-1, 2)
    return Mesh(
        positions=np.array(found.positions),
        uv=np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1),
        faces=corners[..., 0],
        uv_faces=np.where(without_uv, -1, corners[..., 1]),
        face_material=np.array([names.index(name) for name in found.used]),
        materials=tuple(_material(name, looks) for name in names),
    )


def _finite(words: list[str], count: int) -> list[float]:
    """The first `count` numbers; raises ValueError where there are fewer, or one is not finite."""
    found = [float(word) for word in words[:count]]
    if len(found) != count or not np.isfinite(found).all():
        raise ValueError
    return found


def _index(word: str, count: int) -> int:
    """A number from 1, or from -1 for the last, as a number from 0; raises ValueError where nothing has it."""
    number = int(word)
    index = number - 1 if number > 0 else count + number
    if number == 0 or not 0 <= index < count:
        raise ValueError
    return index


def _pictures(path: Path) -> dict[str, Path | None]:
    """The image of each material of a .mtl, None where it has none; raises InputError where it cannot be read."""
    found: dict[str, Path | None] = {}
    name = ""
    for text in read_lines(path):
        key, _, value = text.strip().partition(" ")
        if key == "newmtl":
            name = value.strip()
            found[name] = None
        elif key == "map_Kd":
            found[name] = path.parent / value.strip()
    return found


def _material(name: str, looks: dict[str, Path | None]) -> Material:
    picture = looks.get(name)
    if picture is None:
        return Material(name, pictures.flat(GREY))
    try:
        return Material(name, pictures.decode_image(picture.read_bytes()), alpha_mode="opaque")
    except (OSError, ValueError) as error:
        raise InputError(f"{picture}: the texture of material {name} cannot be read: {error}") from error
