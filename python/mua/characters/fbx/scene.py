"""Scenes of an FBX file: all meshes on their joints, and, for motion, its skeletons alone."""

from collections import Counter
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.characters.fbx.animation import Take, read_takes
from mua.characters.fbx.bindings import array, get, items, load
from mua.characters.fbx.materials import Looks
from mua.characters.fbx.mesh import read_geometry
from mua.characters.fbx.nodes import read_nodes
from mua.characters.fbx.parts import by_material
from mua.characters.fbx.skin import bones_of, read_skin, rigid_skin
from mua.characters.holders import Holders
from mua.characters.messages import STILL, UNHELD, Messages
from mua.characters.node_tree import chain
from mua.errors import InputError
from mua.scene import Motion, Part, Scene, Skin


def read_scenes(path: Path, wanted: str) -> list[Scene]:
    """The scene with all that the file shows and that hangs on a joint, and for `animation` those without a mesh.

    These have the bones of its skins, all bones, and the tree of nodes that its clips move most. Raises InputError
    where the file is broken.
    """
    return Reader(load(path), path, wanted).scenes()


class Reader:
    """One file while it is read."""

    def __init__(self, scene: Any, path: Path, wanted: str) -> None:
        self._path, self._wanted = path, wanted
        self._messages, of_clips = Messages(), Messages()
        self._nodes = read_nodes(scene)
        if not np.isfinite(self._nodes.tree.world).all():
            raise InputError(f"{path}: a node has a transform that is not finite")
        self._takes = read_takes(scene, self._nodes, path, of_clips)
        self._clip_notes = of_clips.notes()
        self._moved = {node for take in self._takes for node in take.moved}
        self._looks = Looks(scene, path, self._messages)
        self._meshes = {
            number: get(source, "mesh")
            for number, source in enumerate(self._nodes.sources)
            if number and get(source, "mesh") is not None
        }
        hidden = self._nodes.tree.hidden
        self._hidden = set() if self._meshes.keys() <= hidden else hidden  # files before 6.0 state it of everything

    def scenes(self) -> list[Scene]:
        """As `read_scenes`."""
        skins, parts = self._meshed()
        scene = replace(
            self._scene(skins),
            parts=tuple(parts),
            materials=tuple(look.material for look in self._looks.read),
            notes=(*self._messages.notes(), *self._clip_notes),
        )
        return [scene, *(self._scene([skin]) for skin in self._bare_skins() if self._wanted == "animation")]

    def _meshed(self) -> tuple[list[Skin], list[Part]]:
        clusters = {node: bones_of(mesh, self._nodes) for node, mesh in self._meshes.items()}
        tree = self._nodes.tree
        joints = {bone for found in clusters.values() for _, bone in found} | self._nodes.bones
        corners = {node: partial(self._points, node) for node in self._meshes}
        holders = Holders(tree, joints, moved=self._moved, meshes=corners)
        skins: list[Skin] = []
        parts: list[Part] = []
        for node in (node for node in tree.order if node in self._meshes):
            holder = None if clusters[node] else holders.of(node)
            if not self._is_drawn(node, skinned=bool(clusters[node])):
                continue
            if not clusters[node] and holder is None:
                self._messages.add(UNHELD, self._nodes.names[node])
                continue
            skin, more = self._mesh(node, holder, skin=len(skins))
            skins.append(skin)
            parts += more
        if parts and not joints:
            self._messages.sharpen(UNHELD, STILL, beyond=len(parts))
        return skins, parts

    def _is_drawn(self, node: int, *, skinned: bool) -> bool:
        flat = np.linalg.det(self._nodes.tree.world[node][:3, :3]) == 0
        if node in self._hidden or (flat and not skinned):
            self._messages.add("Meshes that the file hides are left out: {}.", self._nodes.names[node])
            return False
        if node in self._nodes.details:
            self._messages.add("Lower levels of detail are left out: {}.", self._nodes.names[node])
            return False
        return True

    def _mesh(self, node: int, holder: int | None, *, skin: int) -> tuple[Skin, list[Part]]:
        """The mesh of a node, on a skin of this number; on its clusters, or rigid on `holder`."""
        name = self._nodes.names[node]
        geometry = read_geometry(self._meshes[node], name, self._path, self._messages)
        if holder is None:
            bound, joints, weights = read_skin(geometry, node, self._nodes, self._messages)
        else:
            bound, joints = rigid_skin(node, holder, self._nodes), np.zeros((len(geometry.positions), 1), int)
            weights = np.ones(joints.shape)
        whole = Part(
            name=str(get(geometry.source, "name")) or name,
            group=node,
            positions=geometry.positions,
            faces=geometry.corners[geometry.triangles],
            uv=np.zeros((0, 2)),
            uv_faces=np.full_like(geometry.triangles, -1),
            material=0,
            skin=skin,
            joints=joints,
            weights=weights,
            node=name,
            targets=geometry.targets,
        )
        sources = list(items(self._nodes.sources[node], "materials")) if self._wanted == "skinned" else []
        return bound, by_material(whole, geometry, sources, self._looks, self._messages)

    def _points(self, node: int) -> Array:
        points = array(self._meshes[node], "vertices").reshape(-1, 3)
        return points if len(points) else np.zeros((1, 3))

    def _bare_skins(self) -> list[Skin]:
        """Joints that motion may be on, bound as they rest: all bones, and the tree of nodes that clips move most."""
        tree = self._nodes.tree
        found = [self._at_rest(self._nodes.bones)]
        tops = Counter([*tree.upwards(node)][-1] for node in self._moved)
        if tops:
            top = max(sorted(tops), key=lambda node: tops[node])
            found.append(self._at_rest({node for node in tree.order if top in tree.upwards(node)} & self._carriers()))
        return [skin for skin in found if len(skin.joints)]

    def _carriers(self) -> set[int]:
        """Bones, nodes that clips move, and all above these: what a skeleton is made of."""
        tree = self._nodes.tree
        return {above for node in self._nodes.bones | self._moved for above in tree.upwards(node)}

    def _at_rest(self, nodes: set[int]) -> Skin:
        world = self._nodes.tree.world
        solid = [n for n in sorted(nodes) if abs(np.linalg.det(world[n][:3, :3])) >= np.finfo(np.float32).tiny]
        return Skin(np.array(solid, int), np.linalg.inv(world[solid]))

    def _scene(self, skins: list[Skin]) -> Scene:
        """The joints of these skins and the nodes above them, renumbered parents first, with their motion."""
        nodes, parents = self._nodes.tree.followed(int(node) for skin in skins for node in skin.joints)
        index = {node: n for n, node in enumerate(nodes)}
        motions = [
            self._motion(take, nodes, parents) for take in self._takes if take.weights or set(take.local) & set(nodes)
        ]
        return Scene(
            name=self._path.stem,
            node_names=tuple(self._nodes.names[node] or f"node{node}" for node in nodes),
            parents=parents,
            rest=self._nodes.tree.world[nodes].reshape(-1, 4, 4),
            skins=tuple(replace(skin, joints=np.array([index[int(node)] for node in skin.joints])) for skin in skins),
            parts=(),
            materials=(),
            motions=tuple(motions),
            notes=self._clip_notes,
        )

    def _motion(self, take: Take, nodes: list[int], parents: Array) -> Motion:
        local = np.broadcast_to(self._nodes.local[nodes], (take.frames, len(nodes), 4, 4)).copy()
        for n, node in enumerate(nodes):
            if node in take.local:
                local[:, n] = take.local[node]
        return Motion(take.name, take.rate, chain(local, parents), take.start, take.weights)
