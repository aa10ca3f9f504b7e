"""Print how fast the simulated teacher is recorded, stage by stage, and the memory it takes.

python tools/research/bench_recording.py --texels 768 --frames 40 [CHARACTER]
"""

import argparse
import resource
import tempfile
import time
from pathlib import Path

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.baking.sources import load_character
from mua.pose.encoding import RATE
from mua.recording import TeacherWriter
from mua.teacher import TeacherFrame
from mua.teachers.simulated.teacher import SimulatedTeacher


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("character", nargs="?", type=Path, help="none: the procedural character")
    parser.add_argument("--texels", type=int, default=768)
    parser.add_argument("--frames", type=int, default=40)
    arguments = parser.parse_args()
    character = load_character(arguments.character, uv="auto", seed=0)
    teacher = SimulatedTeacher(character, texels=arguments.texels)
    clip = max(character.clips, key=len)
    spent = {"teacher": 0.0, "writer": 0.0}
    count = 0
    with tempfile.TemporaryDirectory() as directory:
        writer = TeacherWriter(Path(directory) / "recording", teacher.rig, rate=RATE)
        writer.start_clip(clip.name)
        before = time.perf_counter()
        for frame in teacher.frames(clip, range(arguments.frames)):
            if not isinstance(frame, TeacherFrame):
                break
            made = time.perf_counter()
            writer.add(frame.pose, frame.mesh, frame.texture)
            after = time.perf_counter()
            spent["teacher"] += made - before
            spent["writer"] += after - made
            before, count = after, count + 1
        writer.finish()
    total = sum(spent.values())
    valid = len(teacher.rig.texels.texels)
    print(f"{character.name}, {arguments.texels} texels, {valid} of them valid, {count} frames")
    print(*(f"{name} {1000 * seconds / count:.0f} ms a frame" for name, seconds in spent.items()), sep=", ")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(f"{count / total:.2f} frames a second, peak memory {peak:.2f} GiB")


if __name__ == "__main__":
    main()
