"""A person of UMA's layout on disk: videos of the tube of `skeletool_files`, drawn from its files' own matrices."""

from pathlib import Path

import numpy as np
from captures import looking
from PIL import Image, ImageDraw
from skeletool_files import REST, Said, motion_text, sway, write_character

from mua.arrays import Array
from mua.capture.calibration_files import SKELETOOL
from mua.player.video import write_video

SIDE, FOCAL = 64, 90.0  # pixels
FINER = 8  # times finer triangles are drawn: drawing widens them by half a step
CAMERAS = 4
FRAMES = {"training": 6, "testing": 4}
FIRST = {"training": 2, "testing": 0}  # number of the first pose in the .motion: frames before it have none
MIDDLE = np.array([REST[0], 0.87, REST[2]])  # of the tube, metres
FOLDERS = {"training": "skeletoolToGTPose", "testing": "skeletoolToGTPose_test"}


def write_subject(folder: Path) -> Path:
    """Write videos, masks, surfaces in millimetres, calibration, character and poses; returns the subject's folder."""
    metadata = folder.with_name(f"{folder.name}_metadata")
    character = write_character(metadata / "ddc_character")
    (metadata / "cameras.calib").write_text(calibration())
    said = Said.of(*(character.with_suffix(end) for end in (".skeleton", ".obj", ".skin")))
    for take, frames in FRAMES.items():
        dofs = sway(frames + 9)[:: -1 if take == "testing" else 1][:frames]
        poses = character.parent / FOLDERS[take] / "poseAngles.motion"
        poses.parent.mkdir()
        poses.write_text(motion_text(dofs[FIRST[take] :], first=FIRST[take]))
        corners = [said.skinned(REST, pose) for pose in dofs]
        for camera, matrix in enumerate(matrices()):
            drawn = [picture(of_frame, matrix) for of_frame in corners]
            for place, channels in ((".", slice(0, 3)), ("foregroundSegmentation", [3, 3, 3])):
                file = folder / take / place / f"stream{camera:03d}.mp4"
                file.parent.mkdir(parents=True, exist_ok=True)
                write_video(file, (image[..., channels] for image in drawn), rate=25)
        for frame, of_frame in enumerate(corners):
            file = folder / take / "recon_neus2" / f"{frame:06d}.ply"
            file.parent.mkdir(exist_ok=True)
            file.write_text(ply(1000 * of_frame))
    return folder


def matrices() -> list[Array]:
    """World to camera [4, 4], metres, all round."""
    angles = np.arange(CAMERAS) * 2 * np.pi / CAMERAS + 0.3
    return [looking(MIDDLE + 3.2 * np.array([np.sin(a), 0.2, np.cos(a)]), MIDDLE) for a in angles]


def calibration() -> str:
    lines = [SKELETOOL]
    for number, matrix in enumerate(matrices()):
        intrinsic, extrinsic = np.diag([FOCAL, FOCAL, 1, 1]), matrix.copy()
        intrinsic[:2, 2] = (SIDE - 1) / 2
        extrinsic[:3, 3] *= 1000
        lines += [f"name {number}", f"  size {SIDE} {SIDE}"]
        lines += [f"  intrinsic {' '.join(map(repr, intrinsic.ravel().tolist()))}"]
        lines += [f"  extrinsic {' '.join(map(repr, extrinsic.ravel().tolist()))}"]
    return "\n".join([*lines, ""])


def picture(corners: Array, matrix: Array) -> Array:
    """Triangles [F, 3, 3] in metres as a camera sees them, the nearest last, [H, W, 4] uint8."""
    seen = corners @ matrix[:3, :3].T + matrix[:3, 3]
    at = seen[..., :2] / seen[..., 2:] * FOCAL + SIDE / 2
    image = Image.new("RGBA", (FINER * SIDE, FINER * SIDE))
    pen = ImageDraw.Draw(image)
    for face in np.argsort(-seen[..., 2].mean(axis=1)):
        share = face / len(corners)
        color = (int(60 + 180 * share), int(220 - 160 * share), 90 + 60 * (face // 26 % 2), 255)
        pen.polygon([(x - 0.5, y - 0.5) for x, y in (FINER * at[face]).tolist()], fill=color)
    return np.asarray(image.resize((SIDE, SIDE), Image.Resampling.BOX))


def ply(corners: Array) -> str:
    rows = [" ".join(map(str, row)) for row in corners.reshape(-1, 3).tolist()]
    head = f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\n"
    head += "".join(f"property float {axis}\n" for axis in "xyz")
    head += f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    return head + "\n".join([*rows, *(f"3 {3 * f} {3 * f + 1} {3 * f + 2}" for f in range(len(corners)))]) + "\n"
