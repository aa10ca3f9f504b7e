"""Print when a browser shows the first image of an avatar, and what it has read and computed by then.

python tools/research/bench_first_picture.py hero.muaavatar [more.muaavatar] [--rate 2.5] [--runs 3]: the page that
mua-share writes, in a headless browser whose WebGPU is software, on a connection of so many megabytes a second. The
files take turns, each time in a new browser. It needs what tests/web needs, and /proc for the time of the processor.
"""

import argparse
import sys
import time
from contextlib import closing
from io import BufferedIOBase
from pathlib import Path
from typing import IO, Any

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests"), str(ROOT / "tests" / "fixtures")]

from servers import answering  # noqa: E402
from web.browser import Browser  # noqa: E402
from web.pages import ELEMENT  # noqa: E402

from mua.share import server as sharing  # noqa: E402
from mua.share.site import Shown, player_site  # noqa: E402

BLOCK = 1 << 14  # bytes that a slow connection carries at once
SIZE = (640, 400)  # CSS pixels of the page
TICKS = 100  # of a second, in which the system counts processor time
WATCH = f"""document.addEventListener("DOMContentLoaded", () => {{
  const [avatar, seen] = [{ELEMENT}, (globalThis.seen = {{}})];
  for (const kind of ["picture", "load"])
    avatar.addEventListener(kind, () => (seen[kind] ??= {{
      at: performance.now(), when: performance.timeOrigin + performance.now(),
      splats: avatar.avatars[0].splats, whole: avatar.avatars[0].whole,
    }}));
}})"""


class Line:
    """A connection of limited speed, and when it carried how much of the avatars."""

    def __init__(self, rate: float) -> None:
        self.rate = rate  # bytes a second; 0 is as fast as it goes
        self.carried: list[tuple[float, int]] = []  # epoch milliseconds, bytes

    def copy(self, source: IO[bytes], target: BufferedIOBase, first: int, end: int) -> bool:
        """In place of the server's own."""
        source.seek(first)
        slow = self.rate if getattr(source, "name", "").endswith(".muaavatar") else 0
        for at in range(first, end, BLOCK):
            target.write(block := source.read(min(BLOCK, end - at)))
            if slow:
                time.sleep(len(block) / slow)
            if getattr(source, "name", "").endswith(".muaavatar"):
                self.carried.append((1000 * time.time(), len(block)))
        return True

    def until(self, when: float) -> int:
        return sum(size for at, size in self.carried if at <= when)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", type=Path, nargs="+")
    parser.add_argument("--rate", type=float, default=0, help="megabytes a second of the avatar; 0 is no limit")
    parser.add_argument("--runs", type=int, default=3)
    given = parser.parse_args()
    print("file, first picture: seconds, MB read, splats, whole, processor seconds; all: seconds, processor seconds")
    for _ in range(given.runs):
        for file in given.files:
            print(measure(file, 1e6 * given.rate))


def measure(file: Path, rate: float) -> str:
    line = Line(rate)
    sharing._copy = line.copy
    site = player_site([file], Shown(file.stem))
    with sharing.serving(site) as server, answering(server), closing(Browser()) as browser:
        before = processor_seconds(browser)
        address = sharing.address(server)
        with browser.page(address, size=SIZE, before=WATCH, prefers_reduced_motion="reduce") as page:
            page.wait("globalThis.seen?.picture")
            spent = processor_seconds(browser) - before
            page.wait("globalThis.seen.load")
            all_spent = processor_seconds(browser) - before
            seen: Any = page.evaluate("globalThis.seen")
    first, whole = seen["picture"], seen["load"]
    read = line.until(first["when"]) / 1e6
    return (
        f"{file.name}: {first['at'] / 1000:.2f} s, {read:.2f} MB, {first['splats']} splats, {first['whole']}, "
        f"{spent:.1f} s of the processor; {whole['at'] / 1000:.2f} s, {all_spent:.1f} s of the processor"
    )


def processor_seconds(browser: Browser) -> float:
    """Processor time of the browser and all its processes."""
    found = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            if descends(stat.parent.name, browser._process.pid):
                fields = stat.read_text().rpartition(")")[2].split()
                found += int(fields[11]) + int(fields[12])
        except OSError:  # ended meanwhile
            continue
    return found / TICKS


def descends(process: str, ancestor: int) -> bool:
    while int(process) > 1:
        if int(process) == ancestor:
            return True
        process = (Path("/proc") / process / "stat").read_text().rpartition(")")[2].split()[1]
    return False


if __name__ == "__main__":
    main()
