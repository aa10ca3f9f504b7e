"""Skeletool's .skeleton: joints that each turn about or slide along one axis, moved by degrees of freedom (DoFs).

A joint's transform in its parent is a move by its offset, then its turn or slide; its value is the weighted sum of the
DoFs that name it. Lengths are in millimetres. The limits of DoFs are not applied, as in the programs that record them.
"""

from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.skeletool.lines import SKELETON, Line, Lines
from mua.errors import InputError
from mua.pose.skeleton import Skeleton

MILLIMETRES = 1e-3  # metres
KINDS = ("revolute", "prismatic")
NO_PARENT = "none"
COLUMNS = 10  # of a joint: name, kind, parent, offset, axis, scale of the offset


@dataclass(frozen=True, eq=False)
class DofSkeleton:
    """Joints of one axis each, parents first, and what moves them."""

    names: tuple[str, ...]
    parents: Array  # [J] int, -1 for a joint without parent
    offsets: Array  # [J, 3] metres in the parent
    axes: Array  # [J, 3] unit
    turns: Array  # [J] bool: turns about its axis; else slides along it
    dofs: tuple[str, ...]
    weights: Array  # [J, D] radians or millimetres of a joint for 1 of a DoF

    def world(
        self,
        dofs: Array,  # [F, D]
    ) -> tuple[Array, Array]:
        """Joint-to-world rotations [F, J, 4] and positions [F, J, 3], metres."""
        values = dofs @ self.weights.T
        turned = rotation.from_axis_angle(self.axes, np.where(self.turns, values, 0))
        slid = np.where(self.turns, 0, values)[..., None] * MILLIMETRES * self.axes
        still = np.tile([1.0, 0, 0, 0], (len(self.names), 1))
        joints = Skeleton(self.names, self.parents, still, self.offsets, root=0)
        return joints.world(turned, self.offsets + slid)

    def joint_of(self, bone: str) -> int | None:
        """The last of the joints that make up a bone: called as the bone, or as the bone, `_` and more."""
        named = [j for j, name in enumerate(self.names) if name == bone or name.startswith(f"{bone}_")]
        return named[-1] if named else None


def read_skeleton(path: Path) -> DofSkeleton:
    """Read a .skeleton; raises InputError that names the line where it is not as it should be."""
    lines = Lines(path, SKELETON)
    joints = [_joint_line(lines.next("a joint")) for _ in range(lines.section("joints"))]
    if not joints:
        raise InputError(f"{path}: joints is 0, expected at least one")
    for _ in range(lines.section("markers")):
        lines.next("a marker")
    for _ in range(lines.section("scaling joints")):
        for _ in range(lines.next("a scaling joint").whole(-1)):
            lines.next("a joint that is scaled")
    joints = _parents_first(joints)
    index = {line.words[0]: j for j, line in enumerate(joints)}
    names, weights = _dofs(lines, index)
    values = np.array([line.numbers(3) for line in joints])
    lengths = np.linalg.norm(values[:, 3:6], axis=1)
    if not lengths.all():
        raise joints[int(lengths.argmin())].error("the axis is 0 0 0, expected a direction")
    return DofSkeleton(
        names=tuple(index),
        parents=np.array([index.get(line.words[2], -1) for line in joints], np.int32),
        offsets=values[:, :3] * values[:, 6:] * MILLIMETRES,
        axes=values[:, 3:6] / lengths[:, None],
        turns=np.array([line.words[1] == "revolute" for line in joints]),
        dofs=names,
        weights=weights,
    )


def _joint_line(line: Line) -> Line:
    """The line, which is that of a joint; else raises InputError."""
    if len(line.words) != COLUMNS:
        raise line.error(f"has {len(line.words)} columns, expected the {COLUMNS} of a joint")
    if line.words[1] not in KINDS:
        raise line.error(f"joint {line.words[0]} is {line.words[1]!r}, expected {' or '.join(KINDS)}")
    return line


def _parents_first(joints: list[Line]) -> list[Line]:
    """The joints in an order in which each comes after its parent; that of the file where it is one."""
    named: dict[str, Line] = {}
    for line in joints:
        if line.words[0] in named:
            raise line.error(f"a second joint is called {line.words[0]!r}")
        named[line.words[0]] = line
    for line in joints:
        if line.words[2] not in (*named, NO_PARENT):
            raise line.error(f"the parent of {line.words[0]} is {line.words[2]!r}, which is no joint")
    above = {name: [line.words[2]] if line.words[2] != NO_PARENT else [] for name, line in named.items()}
    try:
        order = list(TopologicalSorter(above).static_order())
    except CycleError as circle:
        raise joints[0].error(f"joints are their own parents: {', '.join(circle.args[1])}") from None
    rank = {name: n for n, name in enumerate(named)}
    filed = all(rank[parent] < rank[name] for name, parents in above.items() for parent in parents)
    return joints if filed else [named[name] for name in order]


def _dofs(lines: Lines, joints: dict[str, int]) -> tuple[tuple[str, ...], Array]:
    """Names of the DoFs, and what each moves by how much [J, D]."""
    count = lines.section("dofs")
    names, weights = [], np.zeros((len(joints), count))
    for dof in range(count):
        line = lines.next(f"DoF {dof + 1} of {count}")
        moved = line.whole(-1)
        names.append(line.words[0])
        lines.next(f"the limits of DoF {line.words[0]}")
        for _ in range(moved):
            row = lines.next(f"a joint of DoF {line.words[0]}")
            if len(row.words) != 2 or row.words[0] not in joints:
                raise row.error(
                    f"{' '.join(row.words)!r}, expected a joint that DoF {line.words[0]} moves, and by how much"
                )
            weights[joints[row.words[0]], dof] += row.numbers(1)[0]
    return tuple(names), weights
