"""Characters from .usd, .usda, .usdc and .usdz files, by UsdSkel, else of rigid parts that move."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
from pxr import Tf, Usd, UsdGeom, UsdSkel

from mua.arrays import Array
from mua.characters.animation import Animation, bare_animation, whole_animation
from mua.characters.clip_frames import frame_times
from mua.characters.messages import STILL, UNHELD, Messages
from mua.characters.usd.materials import read_look
from mua.characters.usd.mesh import read_part, subsets
from mua.characters.usd.rigid import Movers, find_movers
from mua.characters.usd.shapes import read_weights, weight_times
from mua.characters.usd.skeleton import NO_TIME, PREDICATE, Bones, animated, bindings, columns, read_bones, read_skin
from mua.errors import InputError
from mua.scene import Material, Motion, Part, Scene, Skin

RATE = 30.0  # frames per second that clips of a file are sampled at

_Nodes: TypeAlias = Bones | Movers


def read_usd(path: Path) -> Scene:
    """Read all skinned meshes of a stage, in metres and Y up, and the animation bound to their skeletons.

    Where nothing is skinned, meshes on prims that move are taken, each rigid on its prim.
    Raises an InputError that names the prim and attribute where the stage is broken.
    """
    return _meshes(_opened(path), path)


def read_usd_animation(path: Path) -> Animation:
    """Read the skeletons of a stage and the animation bound to them: those of its skinned meshes, else all animated.

    Raises an InputError where `read_usd` does, except that a mesh may be missing where a skeleton is animated.
    """
    meshed, bare = usd_scenes(path)
    if any(len(part.faces) for part in meshed.parts):
        return replace(whole_animation(meshed, (), path), notes=())
    return bare_animation(next(bare), path)


def usd_scenes(path: Path) -> tuple[Scene, Iterator[Scene]]:
    """The scene of all meshes that hang on joints, and that of the animated skeletons alone."""
    stage = _opened(path)
    return _meshes(stage, path), _bare(stage, path)


def _bare(stage: Usd.Stage, path: Path) -> Iterator[Scene]:
    skeletons: list[Bones] = []
    queries = animated(stage)
    loose = next((prim for prim in stage.Traverse(PREDICATE) if prim.IsA(UsdSkel.Animation)), None)
    if loose and not queries:
        raise InputError(
            f"{path}: {loose.GetPath()}: no Skeleton is bound to this SkelAnimation; export it with its Skeleton, "
            "whose skel:animationSource names it"
        )
    for query in queries:
        skeletons.append(read_bones(query, path, first=_node_count(skeletons)))
    joints = [bones.first + 1 + np.arange(len(bones.paths)) for bones in skeletons]
    skins = [Skin(at, np.linalg.inv(bones.binds)) for at, bones in zip(joints, skeletons, strict=True)]
    yield _scene(stage, skeletons, skins, name=path.stem)


def _opened(path: Path) -> Usd.Stage:
    try:
        return Usd.Stage.Open(str(path))
    except Tf.ErrorException as broken:
        lines = [line.rpartition(" : ")[2].strip(" '") for line in str(broken).strip().splitlines()]
        raise InputError(f"{path}: USD cannot open the stage: {lines[0]}") from broken


def _meshes(stage: Usd.Stage, path: Path) -> Scene:
    """All that the stage shows and that hangs on a joint, and a sentence on what is left out."""
    messages = Messages()
    drawn = _drawn(stage, messages)
    nodes: list[_Nodes] = []
    skins: list[Skin] = []
    held: list[tuple[Usd.Prim, UsdSkel.SkinningQuery | None]] = []  # one for each skin
    for skeleton, targets in bindings(stage):
        bones = read_bones(skeleton, path, first=_node_count(nodes))
        nodes.append(bones)
        for target in targets:
            if target.GetPrim().GetPath() in drawn:
                skins.append(read_skin(target, bones, path))
                held.append((drawn.pop(target.GetPrim().GetPath()), target))
    skinned = bool(nodes)
    movers = find_movers(stage, [] if held else list(drawn.values()), first=_node_count(nodes))
    nodes.append(movers)
    for mesh in drawn.values():
        holder = movers.holder(mesh)
        if holder is None:
            messages.add(UNHELD, mesh.GetName())
            continue
        skins.append(_rigid_skin(mesh, movers, holder))
        held.append((mesh, None))
    parts, materials = _parts(held, skins, path, messages)
    if parts and not skinned:
        messages.sharpen(UNHELD, STILL, beyond=len(parts))
    scene = _scene(stage, nodes, skins, name=path.stem)
    return replace(scene, parts=parts, materials=materials, notes=messages.notes())


def _drawn(stage: Usd.Stage, messages: Messages) -> dict[object, Usd.Prim]:
    """The meshes that a render of the stage shows, by path; those that it hides are noted."""
    drawn = {}
    for prim in stage.Traverse(PREDICATE):
        if not prim.IsA(UsdGeom.Mesh):
            continue
        shown = UsdGeom.Imageable(prim)
        if shown.ComputeVisibility(NO_TIME) == UsdGeom.Tokens.invisible:
            messages.add("Meshes that the file hides are left out: {}.", prim.GetName())
        elif shown.ComputePurpose() in (UsdGeom.Tokens.guide, UsdGeom.Tokens.proxy):
            messages.add("Guide and proxy meshes are left out: {}.", prim.GetName())
        else:
            drawn[prim.GetPath()] = prim
    return drawn


def _rigid_skin(mesh: Usd.Prim, movers: Movers, holder: int) -> Skin:
    placed = columns(UsdGeom.Xformable(mesh).ComputeLocalToWorldTransform(NO_TIME))
    at_rest = movers.worlds(NO_TIME, at_rest=True)[holder - movers.first]
    return Skin(np.array([holder]), (np.linalg.inv(at_rest) @ placed)[None], rigid=True)


def _parts(
    held: list[tuple[Usd.Prim, UsdSkel.SkinningQuery | None]], skins: list[Skin], path: Path, messages: Messages
) -> tuple[tuple[Part, ...], tuple[Material, ...]]:
    parts: list[Part] = []
    materials: list[Material] = []
    for s, (prim, target) in enumerate(held):
        mesh = UsdGeom.Mesh(prim)
        for owner, faces in subsets(mesh):
            look = read_look(mesh, owner, path, messages)
            at = {"skin": s, "bones": len(skins[s].joints), "material": len(materials)}
            parts.append(read_part(mesh, look, path, target=target, chosen=faces, messages=messages, **at))
            materials.append(look.material)
    return tuple(parts), tuple(materials)


def _scene(stage: Usd.Stage, nodes: Sequence[_Nodes], skins: list[Skin], *, name: str) -> Scene:
    world = _to_metres(stage)
    return Scene(
        name=name,
        node_names=tuple(name for group in nodes for name in group.names),
        parents=np.concatenate([np.zeros(0, int), *(group.parents for group in nodes)]),
        rest=world @ _worlds(nodes, NO_TIME, at_rest=True),
        skins=tuple(skins),
        parts=(),
        materials=(),
        motions=tuple(_motions(stage, nodes, world=world)),
        notes=(),
    )


def _node_count(nodes: Sequence[_Nodes]) -> int:
    return sum(len(group.names) for group in nodes)


def _worlds(nodes: Sequence[_Nodes], time: Usd.TimeCode, *, at_rest: bool) -> Array:
    return np.concatenate([np.zeros((0, 4, 4)), *(group.worlds(time, at_rest=at_rest) for group in nodes)])


def _to_metres(stage: Usd.Stage) -> Array:
    """The matrix [4, 4] from the stage's axes and unit to Y up and metres."""
    world = np.eye(4)
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z:
        world[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    world[:3, :3] *= UsdGeom.GetStageMetersPerUnit(stage)
    return world


def _motions(stage: Usd.Stage, nodes: Sequence[_Nodes], *, world: Array) -> list[Motion]:
    """The one clip of the stage, on all its skeletons at once; none where nothing changes over time."""
    animations = [group.query.GetAnimQuery() for group in nodes if isinstance(group, Bones)]
    animations = [animation for animation in animations if animation]
    times = {t for animation in animations for t in animation.GetJointTransformTimeSamples()}
    times |= weight_times(animations)
    times |= {t for group in nodes for prim in group.prims for t in _transform_times(prim)}
    start, end = (min(times), max(times)) if times else (0.0, 0.0)
    if stage.HasAuthoredTimeCodeRange() and stage.GetStartTimeCode() < end and start < stage.GetEndTimeCode():
        start, end = max(start, stage.GetStartTimeCode()), min(end, stage.GetEndTimeCode())
    per_second = stage.GetTimeCodesPerSecond()
    if (end - start) / per_second < 0.5 / RATE:
        return []
    where = f"{stage.GetRootLayer().identifier}: the animation"
    joints = sum(len(group.prims) for group in nodes)
    seconds = frame_times(start / per_second, end / per_second, RATE, nodes=joints, where=where)
    codes = seconds * per_second
    worlds = [_worlds(nodes, Usd.TimeCode(float(code)), at_rest=False) for code in codes]
    name = animations[0].GetPrim().GetName() if animations else "Animation"
    return [Motion(name, RATE, world @ np.array(worlds), start / per_second, read_weights(animations, codes))]


def _transform_times(prim: Usd.Prim) -> set[float]:
    """When the place of a prim in the world is stated to change."""
    times: set[float] = set()
    while prim and not prim.IsPseudoRoot():
        xform = UsdGeom.Xformable(prim)
        times |= set(xform.GetTimeSamples()) if xform else set()
        prim = prim.GetParent()
    return times
