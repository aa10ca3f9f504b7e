"""Characters and motion of Skeletool, as DDC, ASH, TriHuman and UMA have them: .character and .motion.

Its joints turn or slide along one axis each. The last joint of each bone that carries vertices becomes a joint of the
character; those between are part of its turn and move, so that nothing is lost.
"""

from pathlib import Path

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.animation import Animation
from mua.characters.assemble import assemble
from mua.characters.rigid_motion import local_offsets, local_rotations
from mua.characters.skeletool.character import character_of, read_character_files
from mua.characters.skeletool.mesh import Mesh, read_mesh
from mua.characters.skeletool.motion import read_dofs
from mua.characters.skeletool.skeleton import MILLIMETRES, DofSkeleton, read_skeleton
from mua.characters.skeletool.skin import BoneWeights, read_skin
from mua.pose.clip import Clip
from mua.scene import Part, Scene, Skin, upwards

RATE = 25.0  # frames per second of the family's cameras; no file says it


def read_skeletool(path: Path) -> Scene:
    """Read a .character and the files that it names, in metres.

    Raises an InputError that names file and line where one of them is not as it should be.
    """
    files = read_character_files(path)
    skeleton, mesh = read_skeleton(files.skeleton), read_mesh(files.mesh)
    skin = read_skin(files.skin, skeleton, len(mesh.positions))
    rest = skeleton.world(read_dofs(files.pose, skeleton.dofs)[1][:1])
    return _scene(path.stem, skeleton, skin, mesh, rest)


def read_skeletool_motion(path: Path, *, character: Path | None = None, rate: float = RATE) -> Animation:
    """Read a .motion on the joints of its character, which lies beside it or in the folder above if none is given.

    The world is that of the file, in metres. Raises an InputError that names file and line.
    """
    character = character or character_of(path)
    surfaces = assemble(read_skeletool(character), character)
    skeleton = read_skeleton(read_character_files(character).skeleton)
    turned, placed = skeleton.world(read_dofs(path, skeleton.dofs)[1])
    rig = surfaces.skeleton
    joints = [j for j in (skeleton.joint_of(name) for name in rig.names) if j is not None]
    world = rotation.to_matrix(turned[:, joints])
    clip = Clip(
        path.stem,
        rate,
        rotation.from_matrix(local_rotations(world, rig.parents)),
        surfaces.unit * local_offsets(world, placed[:, joints], rig.parents),
    )
    return Animation(rig, (clip,), (), surfaces.roles)


def _scene(
    name: str,
    skeleton: DofSkeleton,
    skin: BoneWeights,
    mesh: Mesh,
    rest: tuple[Array, Array],  # rotations [1, J, 4] and positions [1, J, 3] of the pose that the mesh is in
) -> Scene:
    """The character at rest, where the file has it."""
    order = np.argsort(skin.joints)
    kept = np.array(skin.joints)[order]
    node_of = np.argsort(order)  # by bone
    matrices = np.tile(np.eye(4), (len(kept), 1, 1))
    matrices[:, :3, :3], matrices[:, :3, 3] = rotation.to_matrix(rest[0][0, kept]), rest[1][0, kept]
    return Scene(
        name=name,
        node_names=tuple(skin.bones[bone] for bone in order),
        parents=_kept_parents(skeleton.parents, kept),
        rest=matrices,
        skins=(Skin(np.arange(len(kept)), np.linalg.inv(matrices)),),
        parts=tuple(_part(mesh, skin, node_of, material) for material in range(len(mesh.materials))),
        materials=mesh.materials,
        motions=(),
        notes=(),
    )


def _kept_parents(parents: Array, kept: Array) -> Array:
    """For each of the joints that are kept the next one above it that is, -1 for none."""
    node = {int(joint): n for n, joint in enumerate(kept)}
    above = ([*upwards(int(parents[joint]), parents)] for joint in kept)
    return np.array([next((node[j] for j in joints if j in node), -1) for joints in above])


def _part(mesh: Mesh, skin: BoneWeights, node_of: Array, material: int) -> Part:
    """The triangles of one material with the vertices that they use."""
    own = mesh.face_material == material
    used, faces = np.unique(mesh.faces[own], return_inverse=True)
    return Part(
        name="mesh",
        group=0,
        positions=mesh.positions[used] * MILLIMETRES,
        faces=faces.reshape(-1, 3),
        uv=mesh.uv,
        uv_faces=mesh.uv_faces[own],
        material=material,
        skin=0,
        joints=node_of[skin.indices[used]],
        weights=skin.weights[used],
    )
