"""A character as in its scene file, before it becomes one surface on rigid joints; filled by the readers."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, TypeAlias

import numpy as np

from mua.arrays import Array
from mua.errors import InputError

Wrap: TypeAlias = Literal["repeat", "clamp", "mirror"]
AlphaMode: TypeAlias = Literal["opaque", "mask", "blend"]

CLEAR = 3  # of 255: what is fainter is not seen, and its colour means nothing


@dataclass(frozen=True, eq=False)
class Material:
    """Base colour of some faces: an image with the material's factor already multiplied in."""

    name: str
    image: Array  # [h, w, 4] uint8 sRGB, at least 1 x 1; as it leaves mua.characters, alpha is opacity
    wrap_u: Wrap = "repeat"
    wrap_v: Wrap = "repeat"
    alpha_mode: AlphaMode = "blend"  # mask: solid where alpha is at least the cut-off, clear elsewhere
    alpha_cutoff: float = 0.5
    opacity: float = 1.0  # what the file multiplies alpha by, where it is not in the image

    @property
    def least(self) -> float:
        """The least opacity, of 255, that is seen."""
        return 255 * self.alpha_cutoff if self.alpha_mode == "mask" else CLEAR


def wrapped(index: Array, count: int, wrap: Wrap) -> Array:
    """Texel indices brought into 0..count - 1 as a material's sampler does."""
    if wrap == "repeat":
        return index % count
    if wrap == "mirror":
        there = index % (2 * count)
        return np.minimum(there, 2 * count - 1 - there)
    return np.clip(index, 0, count - 1)


def upwards(node: int, parents: Array) -> Iterator[int]:
    """A node or joint, its parent, and so on to the top."""
    while node >= 0:
        yield node
        node = int(parents[node])


@dataclass(frozen=True, eq=False)
class Skin:
    """Joints that carry a mesh; `rigid` marks a mesh without weights that only hangs on one joint."""

    joints: Array  # [n] int nodes of the scene
    inverse_binds: Array  # [n, 4, 4] from the mesh's own space to the joint's; rigid: to the joint's in the rest pose
    rigid: bool = False
    quantised: bool = False  # the mesh's own space is then moved and scaled against that of the skeleton


@dataclass(frozen=True, eq=False)
class Target:
    """How far weight 1 of an expression moves vertices of one part; the parts' targets of one name move together."""

    name: str
    vertices: Array  # [n] int into the part's positions, ascending
    offsets: Array  # [n, 3] float64 in the mesh's own space

    def at(
        self,
        kept: Array,  # [m] int, ascending
    ) -> "Target":
        """The target of a part that has these of its vertices."""
        _, rows, vertices = np.intersect1d(self.vertices, kept, assume_unique=True, return_indices=True)
        return Target(self.name, vertices, self.offsets[rows])


@dataclass(frozen=True, eq=False)
class Part:
    """Triangles of one material on one skin; vertices of parts of one group may be welded."""

    name: str
    group: int
    positions: Array  # [N, 3] float64 in the mesh's own space
    faces: Array  # [F, 3] int into positions, counter-clockwise in the mesh's own space
    uv: Array  # [T, 2] float64, v down
    uv_faces: Array  # [F, 3] int into uv, -1 where there are none
    material: int
    skin: int
    joints: Array  # [N, K] int into the skin's joints
    weights: Array  # [N, K] float64, any scale
    node: str = ""  # the file's name of the object that the mesh belongs to
    colors: Array | None = None  # [F, 3, 4] linear colour and opacity of the corners, multiplied into the material
    targets: tuple[Target, ...] = ()


@dataclass(frozen=True, eq=False)
class Motion:
    """Node-to-world matrices of a clip at a steady rate."""

    name: str
    rate: float  # frames per second
    worlds: Array  # [F, nodes, 4, 4] metres, Y up
    start: float = 0.0  # seconds of the first frame, as the file counts them
    weights: Mapping[str, Array] = field(default_factory=dict)  # expression to its weights [F], 0 to 1


@dataclass(frozen=True)
class FaceRules:
    """What a file says of its expressions beside what they move, and of the gaze that turns its eyes."""

    switched: frozenset[str] = frozenset()  # expressions that show wholly above 0.5, else not at all
    # Expression to which of "blink", "look" and "mouth" it holds back: "block" at any weight, "blend" by its weight.
    overrides: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    eyes: tuple[int, ...] = ()  # nodes that gaze turns; none where expressions show it
    reach: Mapping[str, float] = field(default_factory=dict)  # degrees that it turns them "Out", "In", "Up" and "Down"


NO_RULES = FaceRules()


@dataclass(frozen=True, eq=False)
class Scene:
    """Nodes in parent-before-child order with their rest pose, and their skins and parts; metres, Y up."""

    name: str
    node_names: tuple[str, ...]
    parents: Array  # [nodes] int, -1 for a node without parent
    rest: Array  # [nodes, 4, 4] node-to-world matrices, column vectors
    skins: tuple[Skin, ...]
    parts: tuple[Part, ...]
    materials: tuple[Material, ...]
    motions: tuple[Motion, ...]
    notes: tuple[str, ...]
    roles: Mapping[int, str] = field(default_factory=dict)  # node to body part, where the file states it
    face_rules: FaceRules = NO_RULES

    def upwards(self, node: int) -> Iterator[int]:
        """The node, its parent, and so on to the top."""
        return upwards(node, self.parents)

    def masses(self, skin: int) -> Array:
        """The summed weights [n] of each joint of a skin."""
        mass = np.zeros(len(self.skins[skin].joints))
        for part in self.parts:
            if part.skin == skin:
                mass += np.bincount(part.joints.ravel(), part.weights.ravel(), minlength=len(mass))
        return mass


@dataclass(frozen=True, eq=False)
class Source:
    """A scene that became a character: in metres and facing +Z as the character does, its meshes as in the file."""

    scene: Scene
    nodes: Array  # [J] int, the node that each of the character's joints was


def without(scene: Scene, names: Sequence[str], path: Path) -> Scene:
    """The scene less the parts whose mesh, node or material has one of `names`, upper or lower case.

    Raises an InputError that names `path` and the nearest names there are, where none has that name.
    """
    called = [(part.name, part.node, scene.materials[part.material].name) for part in scene.parts]
    known = dict.fromkeys(name for row in called for name in row if name)
    for name in names:
        if name.lower() not in {there.lower() for there in known}:
            lower = {there.lower(): there for there in known}
            near = [lower[there] for there in difflib.get_close_matches(name.lower(), lower, n=3, cutoff=0.5)]
            raise InputError(
                f"{path}: --leave-out {name}: no mesh, node or material has this name; "
                f"{'the nearest are' if near else 'there are'} {', '.join(near or list(known)[:8])}"
            )
    unwanted = {name.lower() for name in names}
    kept = tuple(
        part for part, row in zip(scene.parts, called, strict=True) if not unwanted & {name.lower() for name in row}
    )
    return replace(scene, parts=kept)
