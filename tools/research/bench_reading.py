"""Print what reading a file takes in each language: time of the processor and by the clock, and memory.

python tools/research/bench_reading.py hero.muaavatar hero_packed.muaavatar [--runs 5]: the readers of Python, C# under
mono and JavaScript under Node, each in a process of its own that reads the file so many times. It needs what
tests/unity and tests/web need, and /proc for the memory.
"""

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests" / name) for name in ("", "fixtures", "unity")]

from csharp import PROGRAMS, RUNTIME, CSharp  # noqa: E402

# Seconds of the processor and by the clock of each run, and the most bytes that the first one took; the other readers'
# programs print the same.
PYTHON = """
import json, sys, time
from mua.asset.read import read

def status(name):
    lines = open("/proc/self/status").read().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith(name))

before, seconds, waited, taken = status("VmRSS"), [], [], 0
for _ in range(int(sys.argv[2])):
    start, began = time.process_time(), time.perf_counter()
    read(sys.argv[1])
    seconds.append(time.process_time() - start)
    waited.append(time.perf_counter() - began)
    taken = taken or status("VmHWM") - before
print(json.dumps([seconds, waited, taken]))
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--runs", type=int, default=5)
    given = parser.parse_args()
    program = CSharp().build([RUNTIME / "Format", PROGRAMS / "FormatProgram.cs"])
    readers = {
        "Python": lambda file: [sys.executable, "-c", PYTHON, file],
        "C#": lambda file: ["mono", program, "measured", file],
        "JavaScript": lambda file: ["node", "--no-warnings", ROOT / "tests" / "web" / "modules.mjs", "measured", file],
    }
    print("file, reader: ms of the processor, first and median of the others; by the clock; MB at most; times the file")
    for file in given.files:
        size = file.stat().st_size
        for name, command in readers.items():
            line = [str(part) for part in [*command(file), given.runs]]
            ran = subprocess.run(line, capture_output=True, text=True, check=True)
            *kinds, taken = json.loads(ran.stdout)
            times = [f"{1e3 * one:.0f}, {1e3 * statistics.median(more or [one]):.0f}" for one, *more in kinds]
            print(f"{file.name}, {name}: {'; '.join(times)}; {taken / 1e6:.1f}; {taken / size:.2f}")


if __name__ == "__main__":
    main()
