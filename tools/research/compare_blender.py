"""Compares the readers of characters and motion with Blender: where vertices are at ten frames of a file.

    python tools/research/compare_blender.py FOLDER_OR_FILE... --blender blender/bin/python

One row for each FBX, glTF, VRM or USD file: the program that wrote it, points compared, and the largest distance
between a point and the nearest one of the other side, both ways. Meshes that only one side draws are named. The heads
of bones are compared by name where a file holds motion alone. Frames are spread over all clips; a file without clips
is compared at rest. Between keys Blender interpolates component by component, where glTF asks for the arc and FBX for
curves: a row counts as the same if it is on keys, and tells the rest. Blender opens FBX by its importer in Python,
which shares nothing with ours; where that one fails (text, old versions) or differs, by its newer one, which is built
on ufbx as ours is: such a row says so. Blender is a Python package that needs its own environment:

    python3.11 -m venv blender && blender/bin/pip install bpy==5.0.1
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.characters.fbx.process import scenes_of
from mua.characters.formats import FBX, GLTF, USD
from mua.characters.gltf.read import gltf_scenes
from mua.errors import InputError
from mua.scene import Scene

SEES = Path(__file__).with_name("blender_points.py")
FRAMES = 10
STEP = 5  # frames at 30 per second: every sixth of a second, where files of 24, 30 and 60 have keys
SAME = 1e-3  # metres
SECONDS = 600  # for one file in Blender
WRITERS = (  # of glTF, of FBX as text or binary, of USD as text
    rb'"asset".{1,1000}?"generator" ?: ?"([^"]+)"',
    rb'ApplicationName(?:"|S.{4}).{0,3}KString(?:S.{4}|[", ])*(Maya|MotionBuilder|[A-Z][\w .-]+)',
    rb"Creator[^\n]{1,6}?([A-Z][\w .()/-]+)",
    rb'(?:creator|doc) = "([^"]+)"',
)
ALL = np.ones(FRAMES, bool)
Points = dict[str, Array]  # by object [moments, points, 3], or by bone [moments, 1, 3]; metres, Y up


@dataclass(frozen=True, eq=False)
class View:
    """What a side has at some moments."""

    kind: str  # vertices or bones
    moments: list[tuple[str | None, float]]  # clip and seconds, no clip at rest
    points: Points
    keyed: Array  # [moments] whether all curves have a key there


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", type=Path, nargs="+")
    parser.add_argument("--blender", default="blender/bin/python", help="a Python that has bpy")
    given = parser.parse_args()
    print("| file | written by | points | frames | largest distance, mm | |\n| --- | --- | --- | --- | --- | --- |")
    differing = 0
    for path in (found for place in given.paths for found in files_of(place)):
        row, same = compare(path, blender=given.blender)
        differing += not same
        print(f"| {' | '.join([path.name, writer_of(path), *row])} |", flush=True)
    return min(differing, 1)


def files_of(place: Path) -> Iterator[Path]:
    """A file, or those of a folder and all below that are read here."""
    if not place.is_dir():
        yield place
        return
    yield from (path for path in sorted(place.rglob("*")) if path.suffix.lower() in (FBX, *GLTF, *USD))


def compare(path: Path, *, blender: str) -> tuple[list[str], bool]:
    """The cells of a file's row from its points on, and whether both sides agree or one says why it cannot read it."""
    try:
        ours = view(scenes(path))
    except InputError as refusal:
        return ["", "", "", f"refused: {str(refusal).removeprefix(f'{path}: ')}"], True
    cells: list[str] = []
    for importer in ("python", "ufbx") if is_fbx(path) else ("python",):
        theirs, failure = blender_points(path, ours, blender=blender, importer=importer)
        if theirs is None:
            continue
        before, (cells, same) = cells, _cells(ours, theirs, importer=importer)
        if same:
            cells[-1] += f"; by the older one {before[2]} mm" if before else ""
            return cells, True
        cells = before or cells
    return cells or ["", "", "", f"Blender: {failure}"], not cells


def _cells(ours: "View", theirs: "View", *, importer: str) -> tuple[list[str], bool]:
    apart, words = distances(ours, theirs)
    if importer == "ufbx":
        words.insert(0, "by the newer importer")
    judged = apart[theirs.keyed] if theirs.keyed.any() else apart
    same = bool(judged.max() <= SAME)
    if judged.max() <= SAME < apart.max():
        words.append(f"{1e3 * apart.max():.1f} mm between keys")
    count = sum(points.shape[1] for points in ours.points.values())
    verdict = ", ".join(["same" if same else "DIFFERS", *words])
    return [f"{count:,} {ours.kind}", str(len(judged)), f"{1e3 * judged.max():.3f}", verdict], same


def is_fbx(path: Path) -> bool:
    return path.suffix.lower() == FBX


def scenes(path: Path) -> list[Scene]:
    """The scene of a file's meshes, then those of its skeletons alone."""
    if is_fbx(path):
        return scenes_of(path, "animation")
    if path.suffix.lower() in GLTF:
        meshed, bare = gltf_scenes(path)
    else:
        from mua.characters.usd.read import usd_scenes  # with USD's library, which takes long to load

        meshed, bare = usd_scenes(path)
    return [meshed, *bare]


def view(found: list[Scene]) -> View:
    """The vertices of the meshes at frames spread over all clips; of motion alone, the joints of the skeleton."""
    meshed, *bare = found
    if meshed.parts:
        moments, worlds = _spread(meshed)
        return View("vertices", moments, posed(meshed, worlds), ALL)
    scene = max(bare, key=lambda one: sum(len(skin.joints) for skin in one.skins), default=meshed)
    joints = sorted({int(joint) for skin in scene.skins for joint in skin.joints})
    if not joints:
        raise InputError("neither meshes nor joints were found")
    moments, worlds = _spread(scene)
    return View("bones", moments, {scene.node_names[joint]: worlds[:, joint, None, :3, 3] for joint in joints}, ALL)


def _spread(scene: Scene) -> tuple[list[tuple[str | None, float]], Array]:
    """Clips and seconds of frames spread over all clips, with the worlds [moments, nodes, 4, 4] of the nodes."""
    frames = [(motion, k) for motion in scene.motions for k in range(0, len(motion.worlds), STEP)]
    if not frames:
        return [(None, 0.0)], scene.rest[None]
    chosen = [frames[at] for at in np.unique(np.linspace(0, len(frames) - 1, FRAMES).round().astype(int))]
    moments: list[tuple[str | None, float]] = [(motion.name, motion.start + k / motion.rate) for motion, k in chosen]
    return moments, np.array([motion.worlds[k] for motion, k in chosen])


def posed(scene: Scene, worlds: Array) -> Points:
    """The vertices that faces use, by linear blend skinning, of every mesh by the name of its node."""
    found: dict[str, list[Array]] = {}
    for part in scene.parts:
        skin, used = scene.skins[part.skin], np.unique(part.faces)
        matrices = worlds[:, skin.joints] @ skin.inverse_binds  # [moments, joints, 4, 4]
        weights = part.weights[used] / np.maximum(part.weights[used].sum(axis=1, keepdims=True), 1e-30)
        points = np.concatenate([part.positions[used], np.ones((len(used), 1))], axis=1)
        places = np.zeros((len(worlds), len(used), 3))
        for column, joints in zip(weights.T, part.joints[used].T, strict=True):
            places += column[:, None] * np.einsum("mvij,vj->mvi", matrices[:, joints, :3], points)
        found.setdefault(part.node or part.name, []).append(places)
    return {name: np.concatenate(places, axis=1) for name, places in found.items()}


def blender_points(path: Path, ours: View, *, blender: str, importer: str) -> tuple[View | None, str]:
    """The same moments by Blender; None and its last words where it does not open the file."""
    with tempfile.TemporaryDirectory() as folder:
        job, out = Path(folder) / "job.json", Path(folder) / "points.npz"
        order = {"file": str(path.resolve()), "points": ours.kind, "moments": ours.moments}
        job.write_text(json.dumps({**order, "importer": importer, "out": str(out)}))
        command = [blender, str(SEES), str(job)]
        ended = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=SECONDS)
        if not out.exists():
            said = [line for line in (ended.stdout + ended.stderr).splitlines() if line.startswith("Error: ")]
            return None, (said or ended.stderr.strip().splitlines() or ["ended without a word"])[-1][:200]
        with np.load(out) as held:
            found = {name.removeprefix("points/"): held[name] for name in held.files}
        keyed = found.pop("keyed")
    if ours.kind == "bones":
        found = {name: places[:, None] for name, places in found.items()}
    return View(ours.kind, ours.moments, found, keyed), ""


def distances(ours: View, theirs: View) -> tuple[Array, list[str]]:
    """The largest distance [moments] in metres, and a few words on what one side alone has."""
    mine, other = ours.points, theirs.points
    if ours.kind == "bones":
        apart = [np.linalg.norm(mine[name] - other[name], axis=2)[:, 0] for name in mine if name in other]
        missing = sum(name not in other for name in mine)
        words = [f"Blender lacks {missing} of {len(mine)}"] if missing else []
        return np.max(apart or [np.full(len(ours.moments), np.inf)], axis=0), words
    known, there = ({plain(name) for name in side} for side in (mine, other))
    extra = {name for name in other if plain(name) not in known}
    both = {name: places for name, places in other.items() if name not in extra} or other
    moments = range(len(ours.moments))
    apart = [max(_farthest(mine, other, moment), _farthest(both, mine, moment)) for moment in moments]
    absent = known - there
    words = [f"only in Blender: {' '.join(sorted(extra))}"] if extra else []
    return np.array(apart), words + ([f"only by us: {' '.join(sorted(absent))}"] if absent else [])


def plain(name: str) -> str:
    """A name without the number that Blender gives to the second of its kind."""
    return re.sub(r"\.\d{3}$", "", name)


def _farthest(points: Points, others: Points, moment: int) -> float:
    cloud = [np.concatenate([places[moment] for places in side.values()]) for side in (others, points)]
    return float(cKDTree(cloud[0]).query(cloud[1])[0].max())


def writer_of(path: Path) -> str:
    """The program that a file names as its maker."""
    content = path.read_bytes()
    for pattern in WRITERS:
        match = re.search(pattern, content, re.DOTALL)
        if match:
            return match[1].decode(errors="replace").replace("|", "/")[:60]
    return "?"


if __name__ == "__main__":
    sys.exit(main())
