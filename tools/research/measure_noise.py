"""Print how far images of a virtual capture are from the same images with other noise, and with almost none.

python tools/research/measure_noise.py CAPTURE --blender PYTHON [--pictures 4] [--samples 256]: CAPTURE is a folder that
tools/render_capture.py made. The second figure is what an avatar without any fault would reach. PSNR is taken inside
the box of the mask, on black.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

sys.path.append(str(Path(__file__).resolve().parents[1]))

from capture_job import job_file
from render_capture import RENDERER, require_bpy

OTHER_NOISE = 777_777  # added to the seed of each image


def rerendered(source: Path, chosen: list[dict[str, Any]], samples: int, blender: str) -> list[np.ndarray]:
    """The chosen images of a job rendered again, with other noise and this many samples."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for name in ("surface.npz", "texture.png"):
            (folder / name).symlink_to(source.with_name(name).resolve())
        again = [
            one
            | {"mesh": str((source.parent / one["mesh"]).resolve()), "image": f"{i}.png"}
            | {"seed": one["seed"] + OTHER_NOISE}
            for i, one in enumerate(chosen)
        ]
        job = folder / "job.json"
        job.write_text(json.dumps(json.loads(source.read_text()) | {"samples": samples, "pictures": again}))
        subprocess.run([blender, "-W", "ignore", str(RENDERER), str(job)], check=True, stdout=subprocess.DEVNULL)
        return [picture(folder / one["image"]) for one in again]


def picture(file: Path) -> np.ndarray:
    """[H, W, 4] in 0..1."""
    return np.asarray(Image.open(file)) / 255


def decibels(one: np.ndarray, other: np.ndarray) -> float:
    """PSNR on black, inside the box of the first image's mask."""
    rows, columns = np.nonzero(one[..., 3])
    box = slice(rows.min(), rows.max() + 1), slice(columns.min(), columns.max() + 1)
    apart = (one[..., :3] * one[..., 3:] - other[..., :3] * other[..., 3:])[box]
    return float(-10 * np.log10(np.mean(apart**2)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("capture", type=Path, metavar="CAPTURE")
    parser.add_argument("--blender", default=sys.executable, metavar="PYTHON", help="a Python that has bpy")
    parser.add_argument("--pictures", type=int, default=4, help="how many, spread over the capture")
    parser.add_argument("--samples", type=int, default=256, help="of the images with almost no noise")
    given = parser.parse_args()
    require_bpy(given.blender)
    source = job_file(given.capture)
    job = json.loads(source.read_text())
    made = [one for one in job["pictures"] if (source.parent / one["image"]).exists()]
    chosen = [made[i] for i in np.linspace(0, len(made) - 1, given.pictures).astype(int)]
    held = [picture(source.parent / one["image"]) for one in chosen]
    for samples, what in ((job["samples"], "other noise"), (given.samples, "almost no noise")):
        again = rerendered(source, chosen, samples, given.blender)
        values = [decibels(one, other) for one, other in zip(held, again, strict=True)]
        print(
            f"{samples} samples, {what}: {np.mean(values):.1f} dB ({min(values):.1f} to {max(values):.1f})", flush=True
        )


if __name__ == "__main__":
    main()
