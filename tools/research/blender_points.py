"""Writes where Blender has the vertices of a file, or the heads of its bones; runs in a Python that has bpy.

    python tools/research/blender_points.py JOB.json

A job names the file, the clips and seconds to look at (`moments`), "vertices" or "bones", the importer of FBX and the
.npz to write: for each object [moments, points, 3], or for each bone and object of a motion [moments, 3], in metres
with Y up; and which moments [moments] lie on keys of all curves, because Blender interpolates between keys as no file
asks for. It knows nothing of mua. Blend shapes keep their weights of the rest pose.
"""

import json
import math
import sys
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy_extras.anim_utils import action_get_channelbag_for_slot

NEAR = 0.02  # frames that a key may lie beside the moment looked at
FBX_FIRST = 1.0  # frame on which Blender puts the second 0 of an FBX file; of others it is frame 0


def main() -> None:
    job = json.loads(Path(sys.argv[1]).read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    _open(job["file"], importer=job["importer"])
    for mesh in bpy.data.meshes:
        if mesh.shape_keys:
            mesh.shape_keys.animation_data_clear()
    rest = [(posed, posed.matrix_basis.copy()) for posed in _movable()]
    look = _vertices if job["points"] == "vertices" else _bones
    seen, keyed, playing = [], [], None
    for clip, seconds in job["moments"]:
        if clip is not None and clip != playing:
            for posed, matrix in rest:  # what a clip does not move is as the file has it, not as the last clip left it
                posed.matrix_basis = matrix
            _play(clip)
            playing = clip
        keyed.append(_show(seconds, first=FBX_FIRST if job["file"].lower().endswith(".fbx") else 0.0))
        seen.append(look())
    points: dict[str, Any] = {f"points/{name}": np.array([one[name] for one in seen]) for name in seen[0]}
    np.savez(job["out"], keyed=keyed, **points)


def _open(file: str, *, importer: str) -> None:
    suffix = Path(file).suffix.lower()
    if suffix == ".fbx" and importer == "python":
        bpy.ops.import_scene.fbx(filepath=file)
    elif suffix == ".fbx":
        bpy.ops.wm.fbx_import(filepath=file)
    elif suffix.startswith(".usd"):
        bpy.ops.wm.usd_import(filepath=file)
    else:
        from io_scene_gltf2.blender.imp.animation import BlenderAnimation

        # Else the first clip is shown at once, and nobody can tell where what it moves stands in other clips.
        BlenderAnimation.restore_animation = staticmethod(lambda *_: None)
        bpy.ops.import_scene.gltf(filepath=file, disable_bone_shape=True)


def _movable() -> list[Any]:
    return [*bpy.data.objects, *(bone for thing in bpy.data.objects if thing.pose for bone in thing.pose.bones)]


def _play(clip: str) -> None:
    """Give every object its action of a clip, and none where it has no part in it."""
    actions = [action for action in bpy.data.actions if len(bpy.data.actions) == 1 or _is_of(action.name, clip)]
    for thing in bpy.data.objects:
        data = thing.animation_data or thing.animation_data_create()
        for track in data.nla_tracks:
            track.mute = True
        data.action = None
        for action in actions:
            slots = [slot for slot in action.slots if slot.target_id_type == "OBJECT"]
            own = action.name.startswith(f"{thing.name}|") and _is_of(action.name.removeprefix(f"{thing.name}|"), clip)
            slots = [slot for slot in slots if slot.name_display == thing.name] or (slots if own else [])
            if slots:
                data.action, data.action_slot = action, slots[0]


def _is_of(action: str, clip: str) -> bool:
    """Whether an action's name is that of a clip: alone, behind an object's, before a layer's, or with a number."""
    names = (action, action.partition("|")[2])
    return any(name == clip or name.startswith((f"{clip}|", f"{clip}.")) for name in names)


def _show(seconds: float, *, first: float) -> bool:
    """Go to a moment; whether all curves that play have a key there."""
    scene = bpy.context.scene
    frame = seconds * scene.render.fps / scene.render.fps_base + first
    whole = math.floor(frame + 1e-4)
    scene.frame_set(whole, subframe=max(frame - whole, 0.0))
    return all(abs(keys - frame).min() < NEAR for keys in _playing_keys() if keys[0] < frame < keys[-1])


def _playing_keys() -> Any:
    """The frames [n] of the keys of every curve that plays and is not constant."""
    for data in (thing.animation_data for thing in bpy.data.objects):
        if data and data.action:
            bag = action_get_channelbag_for_slot(data.action, data.action_slot)
            for curve in bag.fcurves if bag else ():
                keys = np.empty(2 * len(curve.keyframe_points))
                curve.keyframe_points.foreach_get("co", keys)
                if len(keys) and np.ptp(keys[1::2]) > 1e-6:
                    yield keys[0::2]


def _vertices() -> dict[str, Any]:
    """The vertices that faces use, of every mesh, as its armature has them."""
    found, graph = {}, bpy.context.evaluated_depsgraph_get()
    meshes = [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.users_scene]
    for thing in meshes:
        for modifier in thing.modifiers:
            modifier.show_viewport = modifier.type == "ARMATURE"
    graph.update()
    for thing in meshes:
        evaluated = thing.evaluated_get(graph)
        mesh = evaluated.to_mesh()
        places, used = np.empty(3 * len(mesh.vertices)), np.empty(len(mesh.loops), int)
        mesh.vertices.foreach_get("co", places)
        mesh.loops.foreach_get("vertex_index", used)
        world = np.array(evaluated.matrix_world)
        found[thing.name] = _y_up(places.reshape(-1, 3)[np.unique(used)] @ world[:3, :3].T + world[:3, 3])
        evaluated.to_mesh_clear()
    return found


def _bones() -> dict[str, Any]:
    """The heads of bones and the origins of all other objects."""
    found = {thing.name: _y_up(np.array(thing.matrix_world.translation)) for thing in bpy.data.objects}
    for thing in bpy.data.objects:
        for bone in thing.pose.bones if thing.pose else ():
            found[bone.name] = _y_up(np.array(thing.matrix_world @ bone.head))
    return found


def _y_up(points: Any) -> Any:
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


main()
