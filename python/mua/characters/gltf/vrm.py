"""VRM avatars: the humanoid bones of a .vrm, which meshes are for the wearer's own eyes, and what is not carried.

VRM 0.x (https://github.com/vrm-c/vrm-specification/tree/master/specification/0.0) and VRM 1.0
(https://github.com/vrm-c/vrm-specification/tree/master/specification/VRMC_vrm-1.0) are glTF with extensions.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mua.characters.gltf.document import Document
from mua.characters.gltf.vrm_expressions import VrmExpression, animated_expressions, read_expressions
from mua.characters.gltf.vrm_look import EYES, eye_reach, look_node
from mua.scene import FaceRules

FIRST, SECOND, ANIMATION = "VRM", "VRMC_vrm", "VRMC_vrm_animation"
SPRINGS, CONSTRAINT, MTOON = "VRMC_springBone", "VRMC_node_constraint", "VRMC_materials_mtoon"

# The roles of mua.pose.joint_names that humanoid bones have; eyes and jaw have none.
_CENTRAL = {"hips": "hips", "neck": "neck", "head": "head"} | dict.fromkeys(("spine", "chest", "upperChest"), "spine")
_SIDED = {
    "Shoulder": "shoulder",
    "UpperArm": "upper_arm",
    "LowerArm": "forearm",
    "Hand": "hand",
    "UpperLeg": "thigh",
    "LowerLeg": "shin",
    "Foot": "foot",
    "Toes": "toe",
} | {
    f"{finger}{segment}": "pinky" if finger == "Little" else finger.lower()
    for finger in ("Thumb", "Index", "Middle", "Ring", "Little")
    for segment in ("Metacarpal", "Proximal", "Intermediate", "Distal")
}
ROLES = _CENTRAL | {f"{side}{bone}": f"{side} {part}" for side in ("left", "right") for bone, part in _SIDED.items()}


@dataclass(frozen=True)
class Vrm:
    """The VRM part of an avatar's file; empty for any other file."""

    bones: Mapping[str, int] = field(default_factory=dict)  # humanoid bone to glTF node
    hidden_nodes: frozenset[int] = frozenset()  # nodes whose meshes only the wearer's own camera shows
    hidden_meshes: frozenset[int] = frozenset()
    expressions: tuple[VrmExpression, ...] = ()
    eye_reach: Mapping[str, float] = field(default_factory=dict)  # degrees that gaze turns the eyes; none: no joints
    expression_nodes: Mapping[int, str] = field(default_factory=dict)  # of an animation: whose x is the weight
    look_node: int | None = None  # of an animation: whose rotation is the gaze
    notes: tuple[str, ...] = ()

    def face_rules(
        self,
        index: Mapping[int, int],  # glTF node to that of a scene
    ) -> FaceRules:
        """What the file says of its expressions and its gaze."""
        eyes = [index[self.bones[eye]] for eye in EYES if self.bones.get(eye) in index]
        return FaceRules(
            switched=frozenset(one.name for one in self.expressions if one.switched),
            overrides={one.name: one.overrides for one in self.expressions if one.overrides},
            eyes=tuple(eyes) if self.eye_reach else (),
            reach=self.eye_reach,
        )

    @property
    def roles(self) -> dict[int, str]:
        """The role of each glTF node that is a humanoid bone with one."""
        return {node: ROLES[bone] for bone, node in self.bones.items() if bone in ROLES}


NO_VRM = Vrm()


def read_vrm(document: Document) -> Vrm:
    """The VRM part of a file, of either version; an InputError names the field where it is broken."""
    extensions = _table(document, document.gltf.extensions or {}, "extensions")
    for name in (FIRST, SECOND, ANIMATION):
        if name in extensions:
            where = f"extensions.{name}"
            vrm = _table(document, extensions[name], where)
            bones = _bones(document, vrm, where, listed=name == FIRST)
            nodes, meshes = _first_person(document, vrm, where)
            expressions, unlike = read_expressions(document, vrm, where)
            reach = eye_reach(document, vrm, where, first=name == FIRST)
            notes = (*_credit(vrm), *_not_carried(document, vrm, extensions), *unlike)
            moved = animated_expressions(document, vrm, where) if name == ANIMATION else {}
            look = look_node(document, vrm, where) if name == ANIMATION else None
            return Vrm(bones, nodes, meshes, () if moved else expressions, reach, moved, look, notes)
    return NO_VRM


def is_toon(material: Any) -> bool:
    """Whether a material is drawn by MToon, which does not look at vertex colours."""
    return MTOON in (material.extensions or {})


def _table(document: Document, value: Any, where: str) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise document.error(f"{where} is {value}, expected an object")
    return value


def _bones(document: Document, vrm: dict[str, Any], where: str, *, listed: bool) -> dict[str, int]:
    """Humanoid bones of VRM 0, a list of {bone, node}, or of VRM 1, a table of bone to {node}."""
    where = f"{where}.humanoid.humanBones"
    humanoid = _table(document, vrm.get("humanoid", {}), where.rpartition(".")[0])
    entries = humanoid.get("humanBones", [] if listed else {})
    if listed and isinstance(entries, list):
        entries = {str(_table(document, entry, where).get("bone")): entry for entry in entries}
    found = {}
    for bone, entry in _table(document, entries, where).items():
        node = _table(document, entry, f"{where}.{bone}").get("node", -1)
        if listed and node == -1:  # UniVRM writes -1 for a bone that is not there
            continue
        document.item("nodes", node, field=f"{where}.{bone}.node")
        found[str(bone)] = int(node)
    return found


def _first_person(document: Document, vrm: dict[str, Any], where: str) -> tuple[frozenset[int], frozenset[int]]:
    """Nodes (VRM 1) and meshes (VRM 0) that only a first-person camera shows."""
    where = f"{where}.firstPerson"
    annotations = _table(document, vrm.get("firstPerson") or {}, where).get("meshAnnotations") or []
    nodes: set[int] = set()
    meshes: set[int] = set()
    for entry in annotations if isinstance(annotations, list) else []:
        entry = _table(document, entry, f"{where}.meshAnnotations")
        if str(entry.get("type", entry.get("firstPersonFlag"))).lower() == "firstpersononly":
            nodes.add(entry.get("node", -1))
            meshes.add(entry.get("mesh", -1))
    return frozenset(nodes), frozenset(meshes)


def _credit(vrm: dict[str, Any]) -> list[str]:
    """Author and licence of the avatar, as far as the file says them."""
    meta = vrm.get("meta")
    if not isinstance(meta, dict):
        return []
    title = meta.get("name") or meta.get("title") or "The avatar"
    authors = meta.get("authors") or meta.get("author")
    author = ", ".join(map(str, authors)) if isinstance(authors, list) else authors
    url = meta.get("licenseUrl") or meta.get("otherLicenseUrl") or meta.get("otherPermissionUrl")
    name = meta.get("licenseName") if meta.get("licenseName") != "Other" or not url else None
    licence = " ".join(str(part) for part in (name and str(name).replace("_", " "), url) if part)
    return [
        f"VRM avatar {title}{f' by {author}' if author else ''}: its licence is "
        f"{licence or 'not named in the file'}; see what it allows before the result is shared."
    ]


def _not_carried(document: Document, vrm: dict[str, Any], extensions: dict[str, Any]) -> list[str]:
    """A sentence for each thing that moves a VRM avatar at run time and is not in a baked one."""
    springs = extensions.get(SPRINGS) or vrm.get("secondaryAnimation") or {}
    chains = springs.get("springs") or springs.get("boneGroups") if isinstance(springs, dict) else None
    nodes = document.gltf.nodes or []
    constrained = sum(1 for node in nodes if CONSTRAINT in (node.extensions or {}))
    notes = []
    if isinstance(chains, list) and chains:
        notes.append(
            f"The avatar's {len(chains)} spring bone groups are left out: what they swing keeps its place, "
            f"and the simulation moves what hangs loose."
        )
    if constrained:
        notes.append(
            f"The constraints on {constrained} of the avatar's nodes are left out; clips that include their effect are "
            "kept."
        )
    return notes
