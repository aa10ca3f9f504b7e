"""A skeleton with an animation as glTF, with or without the skinned template; and one frame's detailed geometry.

Skinning in glTF is linear, with four joints at most, and knows no shape that depends on the pose: the mesh is near the
player's, not equal to it. Materials are unlit, because colours of splats have their light in them.
"""

import numpy as np
from pygltflib import (
    Animation,
    AnimationChannel,
    AnimationChannelTarget,
    AnimationSampler,
    Attributes,
    Material,
    Mesh,
    Node,
    PbrMetallicRoughness,
    Primitive,
    Skin,
    Texture,
    TextureInfo,
)
from pygltflib import Image as Picture

from mua import rotation
from mua.arrays import Array
from mua.avatar.decode import Splats
from mua.export.frames import ExportFrames
from mua.export.glb import INDICES, UNLIT, VERTICES, Glb, to_linear, xyzw
from mua.export.joints import matrices, steady, translated
from mua.export.splats import mean_colors
from mua.export.surface import DetailedMesh, SkinnedMesh, detailed_normals
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

INFLUENCES = 4  # the joints of a vertex that every reader supports


def character_glb(frames: ExportFrames, mesh: SkinnedMesh | None) -> bytes:
    """The content of a .glb with the skeleton, its motion, and the mesh if there is one."""
    skeleton = frames.avatar.rig.skeleton
    glb, joints = _animated(skeleton, frames.poses)
    if mesh is not None:
        glb.document.meshes = [Mesh(name=frames.avatar.name, primitives=[_skinned(glb, mesh)])]
        back = skeleton.bind_inverse
        inverse = matrices(back[:, :4], rotation.dual_translation(back)).astype("<f4")
        roots = np.flatnonzero(skeleton.parents < 0)
        skin = Skin(inverseBindMatrices=glb.accessor(inverse), joints=joints, skeleton=joints[int(roots[0])])
        glb.document.skins = [skin]
        glb.node(Node(name=frames.avatar.name, mesh=0, skin=0))
    return glb.content()


def motion_glb(skeleton: Skeleton, clip: Clip) -> bytes:
    """The content of a .glb with a skeleton and its motion alone; read back, the poses are the same as float32."""
    return _animated(skeleton, clip)[0].content()


def geometry_glb(splats: Splats, mesh: DetailedMesh, *, name: str) -> bytes:
    """The content of a .glb with the detailed geometry of one frame, its colours at the vertices."""
    glb = Glb()
    colors = to_linear(np.clip(mean_colors(splats.sh), 0, 1))
    opaque = np.column_stack([colors, np.ones(len(colors))])
    attributes = Attributes(
        POSITION=glb.accessor(splats.centres.astype("<f4"), target=VERTICES, bounds=True),
        NORMAL=glb.accessor(_unit(detailed_normals(splats, mesh)), target=VERTICES),
        COLOR_0=glb.accessor(np.rint(opaque * 65535).astype("<u2"), target=VERTICES, normalized=True),
    )
    indices = glb.accessor(mesh.faces.ravel().astype("<u4"), target=INDICES)
    _unlit(glb, PbrMetallicRoughness(metallicFactor=0.0, roughnessFactor=1.0))
    primitive = Primitive(attributes=attributes, indices=indices, material=0)
    glb.document.meshes = [Mesh(name=name, primitives=[primitive])]
    glb.node(Node(name=name, mesh=0))
    return glb.content()


def _animated(skeleton: Skeleton, clip: Clip) -> tuple[Glb, list[int]]:
    """A document with the skeleton and its motion, and the nodes of the joints."""
    glb = Glb()
    joints = _joints(glb, skeleton)
    _animate(glb, skeleton, joints, clip)
    return glb, joints


def _joints(glb: Glb, skeleton: Skeleton) -> list[int]:
    """A node for each joint, at rest in the bind pose; the numbers of the nodes."""
    numbers = []
    for j, name in enumerate(skeleton.names):
        children = np.flatnonzero(skeleton.parents == j).tolist()
        node = Node(
            name=name,
            translation=skeleton.bind_translations[j].astype("<f4").tolist(),
            rotation=_unit(xyzw(skeleton.bind_rotations[j])).tolist(),
            children=children or None,  # joints are the first nodes
        )
        numbers.append(glb.node(node, in_scene=skeleton.parents[j] < 0))
    return numbers


def _animate(glb: Glb, skeleton: Skeleton, joints: list[int], clip: Clip) -> None:
    """The motion of every joint: rotations, and translations where a joint moves in its parent."""
    times = glb.accessor((np.arange(len(clip)) / clip.rate).astype("<f4"), bounds=True)
    animation = Animation(name=clip.name)

    def add(joint: int, path: str, values: Array) -> None:
        sampler = AnimationSampler(input=times, output=glb.accessor(values), interpolation="LINEAR")
        animation.samplers.append(sampler)
        target = AnimationChannelTarget(node=joints[joint], path=path)
        animation.channels.append(AnimationChannel(sampler=len(animation.samplers) - 1, target=target))

    rotations, moving = steady(clip.rotations), translated(skeleton, clip)
    for j in range(len(joints)):
        add(j, "rotation", _unit(xyzw(rotations[:, j])))
        if moving[j]:
            add(j, "translation", clip.translations[:, j].astype("<f4"))
    glb.document.animations = [animation]


def _skinned(glb: Glb, mesh: SkinnedMesh) -> Primitive:
    weights = mesh.weights[:, :INFLUENCES].astype("<f4")
    weights = weights / weights.sum(axis=1, keepdims=True)
    joints = np.where(weights > 0, mesh.joints[:, :INFLUENCES], 0).astype("<u2")
    attributes = Attributes(
        POSITION=glb.accessor(mesh.vertices.astype("<f4"), target=VERTICES, bounds=True),
        NORMAL=glb.accessor(_unit(mesh.normals), target=VERTICES),
        TEXCOORD_0=glb.accessor(mesh.uv.astype("<f4"), target=VERTICES),
        JOINTS_0=glb.accessor(joints, target=VERTICES),
        WEIGHTS_0=glb.accessor(weights, target=VERTICES),
    )
    indices = glb.accessor(mesh.faces.ravel().astype("<u4"), target=INDICES)
    glb.document.images = [Picture(bufferView=glb.view(mesh.png), mimeType="image/png", name="texture")]
    glb.document.textures = [Texture(source=0)]
    _unlit(glb, PbrMetallicRoughness(baseColorTexture=TextureInfo(index=0), metallicFactor=0.0, roughnessFactor=1.0))
    return Primitive(attributes=attributes, indices=indices, material=0)


def _unlit(glb: Glb, look: PbrMetallicRoughness) -> None:
    """The file's only material, unlit."""
    glb.use(UNLIT)
    glb.document.materials = [Material(pbrMetallicRoughness=look, extensions={UNLIT: {}}, doubleSided=True)]


def _unit(vectors: Array) -> Array:
    """Unit vectors [..., k] as float32."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)).astype("<f4")
