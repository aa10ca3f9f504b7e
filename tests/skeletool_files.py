"""A small character in the files of Skeletool, and what such files say, evaluated by matrices alone."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation
from tube import tube

from mua.arrays import Array

# Joints in the order of the file, where the chest comes before what carries it; offsets in millimetres.
JOINTS = """
  Root_tx   prismatic none          0   50    0   1 0 0        1.0
  Root_ty   prismatic Root_tx       0    0    0   0 1 0        1.0
  Root_tz   prismatic Root_ty       0    0    0   0 0 1        1.0
  Root_ry   revolute  Root_tz       0    0    0   0 1 0        1.0
  Hips      revolute  Root_ry       0    0    0   0 0 -2       1.0
  HipsScale prismatic Hips          0    0    0   0 1 0        1.0
  Chest     revolute  Spine_rx     10  300  -20   0 0 1        2.0
  Spine_ry  revolute  HipsScale     0  550   15   0 0.6 0.8    1.0
  Spine_rx  revolute  Spine_ry      0    0    0   1 0 0        1.0
"""
DOFS = {  # what each moves; `stretch` moves nothing, two move the chest, one of them in two lines
    "move_x": [("Root_tx", 1000)],
    "move_y": [("Root_ty", 1000)],
    "move_z": [("Root_tz", 1000)],
    "turn": [("Root_ry", 3)],
    "roll": [("Hips", 1)],
    "twist": [("Spine_ry", 0.5), ("Chest", 0.25)],
    "lean": [("Spine_rx", 2)],
    "stretch": [],
    "bend": [("Chest", 1), ("Chest", 0.5)],
    "hips_scale": [("HipsScale", 200)],
}
BONES = ("Chest", "Hips", "Spine")
REST = np.array([0.3, 0.02, -0.2, 0.4, 0.1, -0.3, 0.2, 0.7, 0.1, 0.05])  # the pose that the mesh is in


def write_character(folder: Path, *, millimetre: float = 1.0) -> Path:
    """Write the files of a tube on three bones, which stands where its rest pose has it; returns the .character.

    Lengths are as if `millimetre` were the unit of 1 mm: in metres with 0.001.
    """
    folder.mkdir(parents=True, exist_ok=True)
    character = tube()
    mesh, uv = character.mesh, character.mesh.uv * [1, -1] + [0, 1]
    moved = 1000 * millimetre * (mesh.vertices + np.array([REST[0], 0, REST[2]]))
    corners = np.stack([mesh.faces, mesh.uv_faces], axis=-1) + 1
    names = [character.skeleton.names.index(bone) for bone in BONES]
    at = {joint: bone for bone, joint in enumerate(names)}
    files = {
        "tube.character": "skeletool character file v1.0\n"
        + "".join(f"{label}\n  tube.{end}\n" for label, end in zip(LABELS, ENDS, strict=True)),
        "tube.skeleton": skeleton_text(millimetre),
        "tube.obj": "mtllib ./tube.mtl\n"
        + "".join(f"v {x!r} {y!r} {z!r} 0.5 0.5 0.5\n" for x, y, z in moved.tolist())
        + "".join(f"vt {u!r} {v!r}\n" for u, v in uv.tolist())
        + "usemtl skin\n"
        + "".join(f"f {' '.join(f'{a}/{b}/{a}' for a, b in face)}\n" for face in corners.tolist()),
        "tube.mtl": "newmtl skin\nKd 0 0 0\nmap_Kd tube.png\n",
        "tube.skin": f"Skeletool character skinning file V1.0\nbones:\n {' '.join(BONES)}\nvertex weights:\n"
        + "".join(
            f"{v} {' '.join(f'{at[j]} {w!r}' for j, w in zip(indices[:3], weights[:3], strict=True))}\n"
            for v, (indices, weights) in enumerate(
                zip(character.skin_indices.tolist(), character.skin_weights.tolist(), strict=True)
            )
        ),
        "tube.motion": motion_text(REST[None]),
    }
    for name, text in files.items():
        (folder / name).write_text(text)
    Image.fromarray(character.base_color).save(folder / "tube.png")
    return folder / "tube.character"


LABELS = ("skeleton", "mesh", "skin", "pose")
ENDS = ("skeleton", "obj", "skin", "motion")


def skeleton_text(millimetre: float) -> str:
    joints = [line.split() for line in JOINTS.strip("\n").splitlines()]
    slides = {name for name, kind, *_ in joints if kind == "prismatic"}
    for row in joints:
        row[3:6] = [f"{millimetre * float(word):g}" for word in row[3:6]]
    lines = ["Skeletool Skeleton Definition V1.0", f"joints: {len(joints)}"]
    lines += [f"  {row[0]:9} {row[1]:9} {row[2]:9} {' '.join(row[3:])}" for row in joints]
    lines += ["markers: 1", "  Back Chest point 1 2 3", "scaling joints: 1", "  all 2", "  Hips", "  Chest"]
    lines += [f"dofs: {len(DOFS)}"]
    for dof, moved in DOFS.items():
        lines += [f"  {dof} {len(moved)}", "    nolimits" if len(moved) % 2 else "    limits -0.1 0.1"]
        lines += [f"    {joint} {weight * (millimetre if joint in slides else 1):g}" for joint, weight in moved]
    return "\n".join([*lines, "textureEntries: 0", ""])


def motion_text(dofs: Array, first: int = 0) -> str:
    rows = (f"{first + f} {' '.join(map(repr, row))}" for f, row in enumerate(dofs.tolist()))
    return "\n".join(["Skeletool Motion File V1.0", *rows, ""])


def sway(frames: int) -> Array:
    """DoFs [frames, 10] of the tube that walks to and fro and bends."""
    time = np.arange(frames)[:, None] / 25
    speeds = np.array([2, 1, 3, 1.5, 4, 5, 3, 1, 6, 2])
    return REST + np.array([0.2, 0.01, 0.2, 0.2, 0.2, 0.5, 0.2, 0.1, 0.4, 0.2]) * np.sin(speeds * time)


@dataclass(frozen=True, eq=False)
class Said:
    """What the files of a character say, by their own text."""

    joints: list[list[str]]  # words of each line
    dofs: list[list[tuple[str, float]]]
    bones: list[str]
    corners: Array  # [F, 3] int
    positions: Array  # [V, 3] millimetres
    weights: Array  # [V, bones], rows sum to 1

    @classmethod
    def of(cls, skeleton: Path, mesh: Path, skin: Path) -> "Said":
        words = [line.split() for line in skeleton.read_text().splitlines()]
        begin, end = (
            next(i for i, row in enumerate(words) if row[:1] == [key]) for key in ("dofs:", "textureEntries:")
        )
        joints = [row for row in words if len(row) == 10 and row[1] in ("revolute", "prismatic")]
        dofs, at = [], begin + 1
        while at < end:
            count = int(words[at][1])
            dofs.append([(joint, float(weight)) for joint, weight in words[at + 2 : at + 2 + count]])
            at += 2 + count
        rows = [line.split() for line in mesh.read_text().splitlines()]
        weighted = [line.split() for line in skin.read_text().splitlines()]
        weights = np.zeros((len(weighted) - 4, len(weighted[2])))
        for vertex, *pairs in weighted[4:]:
            for bone, weight in zip(pairs[::2], pairs[1::2], strict=True):
                weights[int(vertex), int(bone)] = float(weight)
        return cls(
            joints,
            dofs,
            weighted[2],
            np.array([[int(word.split("/")[0]) - 1 for word in row[1:]] for row in rows if row[:1] == ["f"]]),
            np.array([row[1:4] for row in rows if row[:1] == ["v"]], float),
            weights / weights.sum(axis=1, keepdims=True),
        )

    def joint_matrices(self, dofs: Array) -> dict[str, Array]:
        """Joint to world [4, 4] in millimetres, by name, of one pose [D]."""
        values = dict.fromkeys((row[0] for row in self.joints), 0.0)
        for moved, dof in zip(self.dofs, dofs, strict=True):
            for joint, weight in moved:
                values[joint] += weight * dof
        named = {row[0]: row for row in self.joints}
        found: dict[str, Array] = {}

        def world(name: str) -> Array:
            if name not in found:
                _, kind, parent, *numbers = named[name]
                offset, axis, scale = np.split(np.array(numbers, float), [3, 6])
                axis = axis / np.linalg.norm(axis)
                placed, moved = np.eye(4), np.eye(4)
                placed[:3, 3] = offset * scale
                if kind == "revolute":
                    moved[:3, :3] = Rotation.from_rotvec(axis * values[name]).as_matrix()
                else:
                    moved[:3, 3] = axis * values[name]
                found[name] = (np.eye(4) if parent == "none" else world(parent)) @ placed @ moved
            return found[name]

        return {name: world(name) for name in named}

    def bone_matrices(self, dofs: Array) -> Array:
        """The same [bones, 4, 4] of the joint in which each bone ends."""
        joints = self.joint_matrices(dofs)
        return np.array([[m for j, m in joints.items() if j == b or j.startswith(b + "_")][-1] for b in self.bones])

    def skinned(self, rest: Array, dofs: Array) -> Array:
        """The triangles' corners [F, 3, 3] in metres, by linear blending of what bones do since the rest pose."""
        moved = self.bone_matrices(dofs) @ np.linalg.inv(self.bone_matrices(rest))
        points = np.concatenate([self.positions, np.ones((len(self.positions), 1))], axis=1)
        posed = np.einsum("vb,bij,vj->vi", self.weights, moved, points)[:, :3] / 1000
        return posed[self.corners]
