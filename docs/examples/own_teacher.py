"""Your own teacher, from recording to rendered image, with a figure made of capsules.

    python docs/examples/own_teacher.py FOLDER

Put your template in the place of `build_rig`, your motion in that of `poses` and your network in that of `teacher`;
docs/recording.md says what each number means.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np

import mua
from mua import rotation
from mua.pose.skeleton import Skeleton
from mua.rig.character import Mesh
from mua.rig.rig import Rig
from mua.rig.texel_map import build_texel_map

RATE = 30.0  # frames per second
TEXELS = 96  # along a side of the texture; a multiple of 16
FRAMES = {"wave": 60, "bow": 45, "both": 30}  # of each clip; the last is held out
EVERY = 3  # frames between two that the teacher is asked for; of the others the pose alone is recorded
SIDES, RINGS = 12, 10  # of each capsule

# name: parent, where the joint is in the bind pose, metres; Y up, the figure looks along Z, its left is along X
JOINTS = {
    "Hips": (None, (0, 0.95, 0)),
    "Chest": ("Hips", (0, 1.2, 0)),
    "Head": ("Chest", (0, 1.5, 0)),
    "LeftArm": ("Chest", (0.2, 1.42, 0)),
    "LeftForeArm": ("LeftArm", (0.47, 1.42, 0)),
    "RightArm": ("Chest", (-0.2, 1.42, 0)),
    "RightForeArm": ("RightArm", (-0.47, 1.42, 0)),
    "LeftLeg": ("Hips", (0.1, 0.9, 0)),
    "RightLeg": ("Hips", (-0.1, 0.9, 0)),
}
NAMES = tuple(JOINTS)
# joints along a capsule, its ends, its radius in metres and colour
CAPSULES = [
    (("Hips", "Chest"), (0, 0.8, 0), (0, 1.5, 0), 0.16, (0.2, 0.4, 0.7)),
    (("Head",), (0, 1.48, 0), (0, 1.78, 0), 0.11, (0.8, 0.6, 0.5)),
    (("LeftArm", "LeftForeArm"), (0.16, 1.42, 0), (0.75, 1.42, 0), 0.06, (0.8, 0.6, 0.5)),
    (("RightArm", "RightForeArm"), (-0.16, 1.42, 0), (-0.75, 1.42, 0), 0.06, (0.8, 0.6, 0.5)),
    (("LeftLeg",), (0.1, 0.95, 0), (0.1, 0.0, 0), 0.08, (0.3, 0.3, 0.3)),
    (("RightLeg",), (-0.1, 0.95, 0), (-0.1, 0.0, 0), 0.08, (0.3, 0.3, 0.3)),
]


def build_rig() -> Rig:
    """What a recording has to know of the character: skeleton, template, skin weights, texels."""
    positions = np.array([position for _, position in JOINTS.values()], dtype=float)
    parents = np.array([-1 if parent is None else NAMES.index(parent) for parent, _ in JOINTS.values()], np.int32)
    skeleton = Skeleton(
        names=NAMES,
        parents=parents,
        bind_rotations=np.tile([1.0, 0, 0, 0], (len(NAMES), 1)),  # wxyz
        bind_translations=np.where(
            parents[:, None] < 0, positions, positions - positions[parents]
        ),  # from parent to joint
        root=0,
    )
    vertices, faces, uv, uv_faces, indices, weights = (
        np.concatenate(part) for part in zip(*map(capsule, range(6)), strict=True)
    )
    mesh = Mesh(vertices, faces, uv, uv_faces)
    return Rig(skeleton, mesh, indices, weights, build_texel_map(mesh, TEXELS))


def capsule(number: int) -> tuple[np.ndarray, ...]:
    """One capsule with a UV chart of its own: vertices, faces, UVs, faces in UV, joints and weights of the vertices."""
    joints, start, end, radius, _ = CAPSULES[number]
    start, axis = np.array(start, float), np.subtract(end, start)
    across = np.cross(axis, [0, 0, 1.0]) / np.linalg.norm(axis)
    along, around = np.mgrid[: RINGS + 1, :SIDES].reshape(2, -1)
    share, angle = along / RINGS, 2 * np.pi * around / SIDES
    width = radius * np.sqrt(np.clip(1 - (2 * share - 1) ** 6, 0.02, 1))  # rounded ends
    ring = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * [0, 0, 1.0]
    vertices = start + share[:, None] * axis + width[:, None] * ring

    ring_at, side = np.mgrid[:RINGS, :SIDES].reshape(2, -1)
    nodes = [(ring_at, side), (ring_at, side + 1), (ring_at + 1, side + 1), (ring_at + 1, side)]
    closed = [r * SIDES + s % SIDES for r, s in nodes]  # the last side meets the first one on the surface
    opened = [r * (SIDES + 1) + s for r, s in nodes]  # but not in the texture
    triangles = [(0, 2, 1), (0, 3, 2)]  # counter-clockwise seen from outside
    faces, uv_faces = (np.concatenate([np.stack([q[i] for i in t], 1) for t in triangles]) for q in (closed, opened))
    rows, columns = np.mgrid[: RINGS + 1, : SIDES + 1].reshape(2, -1)
    corner = np.array([number % 3 / 3, number // 3 / 2])
    uv = corner + (0.05 + 0.9 * np.stack([columns / SIDES, rows / RINGS], 1)) * [1 / 3, 1 / 2]  # v down

    indices = np.zeros((len(vertices), 8), np.int32)
    weights = np.zeros((len(vertices), 8), np.float32)
    second = np.clip(4 * share - 1.5, 0, 1) if len(joints) > 1 else 0 * share  # the bend is in the middle
    for column, (joint, weight) in enumerate(zip((joints[0], joints[-1]), (1 - second, second), strict=True)):
        indices[:, column], weights[:, column] = NAMES.index(joint), weight
    first_vertex, first_uv = number * len(vertices), number * len(uv)
    return (
        vertices,
        (faces + first_vertex).astype(np.int32),
        uv,
        (uv_faces + first_uv).astype(np.int32),
        indices,
        weights,
    )


def poses(rig: Rig, clip: str) -> list[mua.Pose]:
    """The frames of a clip: what a motion capture would give."""
    frames = []
    for frame in range(FRAMES[clip]):
        swing = np.sin(2 * np.pi * frame / 30)
        rotations = rig.skeleton.bind_rotations.copy()
        if clip in ("wave", "both"):
            rotations[NAMES.index("LeftArm")] = rotation.from_axis_angle([0, 0, 1.0], 0.4 + 0.5 * swing)
            rotations[NAMES.index("LeftForeArm")] = rotation.from_axis_angle([0, 0, 1.0], 0.8 * swing)
        if clip in ("bow", "both"):
            rotations[NAMES.index("Chest")] = rotation.from_axis_angle([1.0, 0, 0], 0.4 + 0.4 * swing)
        frames.append(mua.Pose(rotations, rig.skeleton.bind_translations))
    return frames


def teacher(rig: Rig, pose: mua.Pose) -> tuple[np.ndarray, np.ndarray]:
    """What your network puts out for a pose: canonical mesh [V, 3] and texture [N, 23] at the valid texels."""
    bend = 2 * np.arccos(np.clip(np.abs(pose.rotations[:, 0]), 0, 1))  # of each joint, radians
    chest, fore_arm = bend[NAMES.index("Chest")], bend[NAMES.index("LeftForeArm")]
    texels = rig.texels
    corners = rig.mesh.faces[texels.triangles]
    skin = np.einsum("nvk,nv->nk", rig.skin_weights[corners], texels.barycentrics)
    number = texels.triangles // (2 * RINGS * SIDES)  # which capsule a texel is on

    mesh = rig.mesh.vertices.copy()
    of_arm = (rig.skin_indices[:, 0] == NAMES.index("LeftArm"))[:, None]
    thicker = 0.3 * fore_arm * rig.skin_weights[:, :1] * rig.skin_weights[:, 1:2]
    mesh += of_arm * thicker * (mesh - [0.47, 1.42, 0]) * [0, 1, 1]  # a muscle that swells as the elbow bends

    texture = np.zeros((len(texels.texels), 23), np.float32)
    texture[:, 3] = 1  # quaternion wxyz: these splats are round, so that any will do
    texture[:, 7:10] = np.log(0.6 * step_between_texels(rig))[:, None]  # natural logarithm of metres
    texture[:, 10] = 4  # logit: an opacity of 0.98
    colour = np.array([capsule[-1] for capsule in CAPSULES])[number]
    heights = np.einsum("nv,nv->n", rig.mesh.vertices[corners][:, :, 1], texels.barycentrics)
    stripes = 0.1 * np.sin(40 * heights)[:, None]
    shadow = 0.2 * chest * (number == 0)[:, None] * skin[:, :1]  # the belly darkens as the figure bows
    texture[:, 11:14] = (np.clip(colour + stripes - shadow, 0, 1) - 0.5) / 0.2821  # constant SH coefficients
    return mesh, texture


def step_between_texels(rig: Rig) -> np.ndarray:
    """How far apart neighbouring texels are on the surface [N], metres: what splats have to cover."""
    a, b, c = rig.mesh.vertices[rig.mesh.faces].swapaxes(0, 1)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    a, b, c = (TEXELS * rig.mesh.uv[rig.mesh.uv_faces]).swapaxes(0, 1)
    in_texture = np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1)))
    return np.sqrt(area / in_texture)[rig.texels.triangles]


def record(folder: Path) -> Path:
    """Write the recording; run again after a kill, it goes on where it stopped."""
    rig = build_rig()
    with mua.TeacherWriter(folder / "recording", rig, rate=RATE, whole_every=5) as writer:
        for clip in FRAMES:
            if writer.is_complete(clip):
                continue
            writer.start_clip(clip, held_out=clip == "both")
            for frame, pose in enumerate(poses(rig, clip)):
                if frame < writer.next_frame(clip):
                    continue  # stored by a run that was killed
                seen = teacher(rig, pose) if frame % EVERY == 0 else ()
                writer.add(pose, *seen, frame=frame)
    return folder / "recording"


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/examples/own_teacher.py FOLDER")
    folder = Path(sys.argv[1])
    recording, avatar = record(folder), folder / "figure.muaavatar"
    train = [sys.executable, "-m", "mua.cli.train", str(recording), "-o", str(avatar)]  # mua-train in a shell
    subprocess.run([*train, "--check"], check=True)  # what was understood, with a picture of three frames
    subprocess.run([*train, "--preset", "tiny"], check=True)
    splats = mua.load(avatar).decode("both", 8)
    mua.render(splats).save(folder / "figure.png")
    print(f"look at {folder / 'figure.png'}, or at all of it: mua-view {avatar}")


if __name__ == "__main__":
    main()
