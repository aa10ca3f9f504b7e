"""Makes a capture without cameras: a rigged character in motion, rendered with Blender's Cycles from a ring of cameras.

    python tools/render_capture.py hero.glb --motion walk.bvh dance.bvh -o captures/hero --blender blender/bin/python

Cloth hangs and swings by the simulation of mua-bake (--still: joints alone move the surface); the character is kept on
the spot. FOLDER becomes a capture: template, motion on its skeleton, images whose alpha is the mask, true surfaces
and calibration. A second run goes on where the first one stopped. Blender is a Python package that needs its own
environment, best beside the project:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1
"""

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

from capture_fit import measure_fit
from capture_job import LIGHTS, Order, job_file, prepare

from mua.capture import open_capture
from mua.errors import InputError

RENDERER = Path(__file__).with_name("cycles_render.py")
WORST_FIT = 1.0  # pixels between the edges of true surface and image: more is a wrong calibration
HOW_TO_GET = "make one with `python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1`"


def render_capture(order: Order, folder: Path, *, blender: str, threads: int) -> None:
    """Make the capture of an order, or go on with it.

    Errors: InputError where something cannot be read, or where the folder holds the capture of another order.
    """
    require_bpy(blender)
    job = job_file(folder)
    if job.exists():
        require_same(json.loads(job.read_text())["order"], order, folder)
    else:
        prepare(order, folder)
    begun = time.monotonic()
    run_renderer([blender, str(RENDERER), str(job), "--threads", str(threads)], log=job.with_name("blender.log"))
    print(f"rendering took {(time.monotonic() - begun) / 60:.1f} minutes")
    check_fit(folder)


def require_bpy(blender: str) -> None:
    """Raises InputError where a Python has no Blender."""
    look = "import importlib.util, sys; sys.exit(importlib.util.find_spec('bpy') is None)"
    try:
        found = subprocess.run([blender, "-c", look], capture_output=True, check=False).returncode == 0
    except OSError as error:
        raise InputError(f"--blender {blender}: cannot be started: {error.strerror}") from error
    if not found:
        raise InputError(f"{blender} is a Python without Blender's bpy; {HOW_TO_GET}, then add --blender PYTHON")


def require_same(held: dict[str, object], order: Order, folder: Path) -> None:
    """Raises InputError where a folder holds the capture of another order."""
    for field, value in json.loads(json.dumps(asdict(order))).items():
        if held.get(field) != value:
            raise InputError(
                f"{folder}: holds a capture with {field.replace('_', ' ')} {held.get(field)}, "
                f"but {value} is asked for; name another folder or delete this one"
            )


def run_renderer(command: Sequence[str], *, log: Path) -> None:
    """Run the renderer and print how far it is; all else that it says goes to `log`."""
    with (
        log.open("w") as output,
        subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child,
    ):
        for line in child.stdout or ():
            if line.startswith("rendered "):
                print(line.rstrip(), flush=True)
            else:
                output.write(line)
    if child.returncode:
        raise InputError(f"rendering ended with status {child.returncode}; {log} says why; the same command goes on")


def check_fit(folder: Path) -> None:
    """Print how well the true surfaces fit the images; raises InputError where they do not."""
    fit = measure_fit(open_capture(folder))
    print(
        f"{folder}: the edges of the true surface lie {fit.mean:.2f} pixels from those of the mask on the mean of "
        f"{fit.pictures} images, {fit.worst:.2f} in the worst ({fit.where})"
    )
    if fit.worst > WORST_FIT:
        raise InputError(f"{fit.where}: the true surface is {fit.worst:.2f} pixels beside it, expected {WORST_FIT:g}")


def at_least(least: int) -> Callable[[str], int]:
    """A reader of whole numbers for the command line."""

    def number(text: str) -> int:
        if not text.strip().isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"is {text!r}, expected a whole number of at least {least}")
        return int(text)

    return number


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = made.add_argument
    lights = "; ".join(f"{name}: {what}" for name, what in LIGHTS.items())
    add("character", metavar="CHARACTER", help="a rigged character that mua-bake reads: .glb, .gltf, .vrm or USD")
    add("--motion", nargs="+", default=(), metavar="PATH", help="files or folders of motion; else the character's own")
    add("--held-out-motion", nargs="+", default=(), metavar="PATH", help="motion to test with; else the last clip")
    add("-o", "--output", type=Path, required=True, metavar="FOLDER", help="where the capture goes")
    add("--cameras", type=at_least(1), default=8, help="cameras to train on; default %(default)s")
    add("--held-out-cameras", type=at_least(0), default=2, help="cameras to test with; default %(default)s")
    add("--size", type=at_least(16), default=256, help="pixels of an image along a side; default %(default)s")
    add("--frames", type=at_least(1), default=100, help="frames to train on; default %(default)s")
    add("--held-out-frames", type=at_least(0), default=30, help="frames to test with; default %(default)s")
    add("--samples", type=at_least(1), default=16, help="light paths for each pixel; default %(default)s")
    add("--light", choices=tuple(LIGHTS), default="studio", help=f"{lights}; default %(default)s")
    add("--seed", type=at_least(0), default=0, help="chooses cloth folds, cameras and noise; default %(default)s")
    add("--height", type=float, help="metres from sole to crown, where the file's unit is wrong")
    add("--leave-out", nargs="+", default=(), metavar="NAME", help="meshes, nodes or materials not to be filmed")
    add("--still", action="store_true", help="joints alone move the surface: nothing is simulated")
    add("--threads", type=at_least(1), default=2, help="processor cores to render on; default %(default)s")
    add("--blender", default=sys.executable, metavar="PYTHON", help="a Python that has bpy; default this one")
    return made


def main() -> None:
    given = vars(parser().parse_args())
    folder, blender, threads = (given.pop(name) for name in ("output", "blender", "threads"))
    given |= {name: tuple(given[name]) for name in ("motion", "held_out_motion", "leave_out")}
    try:
        render_capture(Order(**given), folder, blender=blender, threads=threads)
    except InputError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
