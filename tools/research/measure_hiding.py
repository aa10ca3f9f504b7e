"""Print what an inset template mesh in the depth buffer hides of an avatar, beside its one-sided texels.

python tools/research/measure_hiding.py hero.muaavatar --clip walk_07 --frame 280 --motion jump.bvh: first how far the
posed template must be moved inwards so that it hides no splat that is seen in the avatar's most different poses; then,
from all sides as an eye of a headset sees a frame of the clip and one of the motion, the splats and fragments that are
left, decibels against the exact image, and what a Quest 3 would take to draw both eyes, modelled.
"""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import torch
import warp as wp
from measure_drawing import SIDES, decibels, exact, marked

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.bench.counts import SCREEN, Drawn, eye_before
from mua.bench.devices import DEVICES
from mua.bench.instructions import fragment_instructions
from mua.bench.model import TRIANGLES, drawing_ms
from mua.bench.work import DUAL_QUATERNION
from mua.camera import Camera
from mua.coarser import texel_length
from mua.decode import Splats, box_of, decode_clip_frame
from mua.motion.load import load_motions
from mua.one_sided import LARGEST_SHARE, VIEWS, around, distinct_poses
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.rig.rig import Rig
from mua.splatting.projection import Eye, Quads, TorchSplats, half_extents, project
from mua.splatting.rasterise import largest_shares
from mua.splatting.tiles import TILE, assign

DEVICE = "quest3"
EYES = 2
MOST = 0.3  # metres; so far inwards nothing is left of a person
STEPS = 9  # halvings of it
SHARES = (LARGEST_SHARE, 1 / 255)  # of a pixel's colour, from which on a splat counts as seen
LOST = (0.0, 0.001, 0.01)  # of the splats that are seen, summed over views
SAME_PLACE = 1e-6  # of the figure's size: vertices so near to each other move together, as along the seams of a texture
START = 1e-4  # metres
NOTHING = np.float32(1e30)  # metres, where no mesh is
# Of a vertex and a triangle of the mesh, once for an eye; a map of depth that a kernel reads is written, then read.
VERTEX_BYTES, TRIANGLE_BYTES = 12 + DUAL_QUATERNION + 4, 12  # place, dual quaternion, normal; indices
MAP_BYTES = 2 * 4 * (SCREEN[0] // 4) * (SCREEN[1] // 4)  # a quarter of the pixels along either side


@wp.kernel(enable_backward=False)
def depths_below(
    mesh: wp.uint64,
    vertices: wp.array[wp.vec3],
    normals: wp.array[wp.vec3],
    start: float,  # metres below the surface, so that the vertex's own triangles are not met
    depths: wp.array[wp.float32],  # [V] metres to the next surface inwards; 0 where there is none
):
    vertex = wp.tid()
    inwards = -normals[vertex]
    met = wp.mesh_query_ray(mesh, vertices[vertex] + start * inwards, inwards, MOST)
    if met.result:
        depths[vertex] = start + met.t


@wp.kernel(enable_backward=False)
def nearest_surface(
    corners: wp.array2d[wp.float32],  # [3 F, 3] column, row, depth
    width: int,
    height: int,
    depths: wp.array[wp.float32],  # [W H]
):
    a = 3 * wp.tid()
    if corners[a, 2] <= 0.0 or corners[a + 1, 2] <= 0.0 or corners[a + 2, 2] <= 0.0:
        return
    ux = corners[a + 1, 0] - corners[a, 0]
    uy = corners[a + 1, 1] - corners[a, 1]
    vx = corners[a + 2, 0] - corners[a, 0]
    vy = corners[a + 2, 1] - corners[a, 1]
    area = ux * vy - uy * vx
    if area >= 0.0:  # rows run down: a triangle that faces the eye runs round the other way
        return
    left = wp.min(wp.min(corners[a, 0], corners[a + 1, 0]), corners[a + 2, 0])
    right = wp.max(wp.max(corners[a, 0], corners[a + 1, 0]), corners[a + 2, 0])
    top = wp.min(wp.min(corners[a, 1], corners[a + 1, 1]), corners[a + 2, 1])
    bottom = wp.max(wp.max(corners[a, 1], corners[a + 1, 1]), corners[a + 2, 1])
    for row in range(wp.max(int(wp.ceil(top - 0.5)), 0), wp.min(int(wp.floor(bottom - 0.5)), height - 1) + 1):
        for column in range(wp.max(int(wp.ceil(left - 0.5)), 0), wp.min(int(wp.floor(right - 0.5)), width - 1) + 1):
            x = float(column) + 0.5 - corners[a, 0]
            y = float(row) + 0.5 - corners[a, 1]
            second = (x * vy - y * vx) / area
            third = (ux * y - uy * x) / area
            if second >= 0.0 and third >= 0.0 and second + third <= 1.0:
                nearness = (1.0 - second - third) / corners[a, 2] + second / corners[a + 1, 2]
                wp.atomic_min(depths, row * width + column, 1.0 / (nearness + third / corners[a + 2, 2]))


@wp.kernel(enable_backward=False)
def drawn_pixels(
    places: wp.array2d[wp.int32],  # [T, 5] of mua.splatting.tiles.Tiles
    starts: wp.array[wp.int32],
    quads: wp.array[wp.int32],
    shapes: wp.array2d[wp.float32],  # [M, 6] of mua.splatting.projection.Quads
    colors: wp.array2d[wp.float32],
    before: wp.array[wp.float32],  # [M] metres in front of the eye
    surface: wp.array[wp.float32],  # [W H] depth that hides what lies behind
    image: wp.array2d[wp.float32],  # [W H, 4]
    fragments: wp.array[wp.int32],  # [W H]
):
    tile = wp.tid() // (TILE * TILE)
    inner = wp.tid() % (TILE * TILE)
    column = places[tile, 0] + inner % TILE
    row = places[tile, 1] + inner // TILE
    if column >= places[tile, 2] or row >= places[tile, 3]:
        return
    left = wp.float32(1.0)
    at = row * places[tile, 2] + column
    for pair in range(starts[tile], starts[tile + 1]):
        quad = quads[pair]
        x = float(column) + 0.5 - shapes[quad, 0]
        y = float(row) + 0.5 - shapes[quad, 1]
        u = 1.0 - (shapes[quad, 2] * x + shapes[quad, 3] * y) ** 2.0
        v = 1.0 - (shapes[quad, 3] * x + shapes[quad, 4] * y) ** 2.0
        if u > 0.0 and v > 0.0 and before[quad] <= surface[at]:
            weight = left * shapes[quad, 5] * u * v
            for channel in range(3):
                image[at, channel] += weight * colors[quad, channel]
            left -= weight
            fragments[at] += 1
    image[at, 3] = 1.0 - left


@dataclass(frozen=True, eq=False)
class Mesh:
    """A posed template."""

    vertices: Array  # [V, 3] world, metres
    normals: Array  # [V, 3] outwards, unit
    faces: Array  # [F, 3]
    room: Array  # [V] metres that a vertex may move inwards

    def inset_faces(self, inset: float) -> Array:
        """Those that can be moved so far [F', 3]: what is thinner would be turned inside out."""
        return np.asarray(self.faces[(self.room[self.faces] >= inset).all(axis=1)])

    def depths(self, camera: Camera, inset: float) -> Array:
        """Of the mesh moved inwards by so many metres, [H, W] metres, NOTHING where it is not."""
        width, height = camera.screen
        faces = self.inset_faces(inset)
        corners = wp.array(on_screen(self.vertices - inset * self.normals, camera)[faces].reshape(-1, 3))
        depths = wp.full(width * height, NOTHING, dtype=wp.float32, device="cpu")
        wp.launch(nearest_surface, dim=len(faces), inputs=[corners, width, height, depths], device="cpu")
        return np.asarray(depths.numpy().reshape(height, width))


@dataclass(frozen=True, eq=False)
class View:
    """What is seen of a pose from one place."""

    camera: Camera
    mesh: Mesh
    at: Array  # [M, 3] column, row and depth of the splats that are seen
    shares: Array  # [M] the largest of any pixel's colour

    def hidden(self, inset: float) -> Array:
        """Whether the inset mesh hides each splat, [M]."""
        return behind(self.at, self.mesh.depths(self.camera, inset))


@dataclass(frozen=True)
class Way:
    """A way to leave splats out."""

    name: str
    marks: bool = False
    inset: float | None = None  # metres
    whole: bool = False  # splats whose middle is hidden, in place of fragments


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=Path)
    parser.add_argument("--clip", help="the first if left out")
    parser.add_argument("--frame", type=int, help="of the avatar's rate; the middle one if left out")
    parser.add_argument(
        "--motion", type=Path, help="file of motion that was not recorded; its middle frame is drawn too"
    )
    parser.add_argument("--distance", type=float, action="append", help="metres; 2.2 and 1.0 if left out")
    parser.add_argument(
        "--inset", type=float, action="append", help="millimetres to draw with; what is found if left out"
    )
    given = parser.parse_args()
    torch.set_num_threads(1)
    avatar = read(given.file)
    insets = [millimetres / 1000 for millimetres in given.inset or []] or print_insets(avatar)
    print("\n| pose | metres | left out by | thousand splats | million fragments | dB, least and mean | more MB | ms |")
    print("| --- | ---: | --- | ---: | ---: | --- | ---: | ---: |")
    clips = [resample(avatar.clip(given.clip) if given.clip else avatar.clips[0], avatar.encoding.rate)]
    if given.motion is not None:
        rate, skeleton = avatar.encoding.rate, avatar.rig.skeleton
        clips += [loaded.clip for loaded in load_motions(given.motion, skeleton, mapping=None, rate=rate)]
    for clip in clips:
        frame = len(clip) // 2 if given.frame is None or clip is not clips[0] else given.frame
        for distance in given.distance or (2.2, 1.0):
            print_ways(avatar, clip, frame, distance, ways(avatar, insets))


def print_insets(avatar: Avatar) -> list[float]:
    """Print the insets that are needed; returns those for LARGEST_SHARE, metres."""
    views = views_of(avatar, avatar.clips)
    print("| seen from a share of | " + " | ".join(f"{lost:.1%} lost" for lost in LOST) + " |")
    print("| --- |" + " ---: |" * len(LOST))
    found = {share: [least_inset(views, share, lost) for lost in LOST] for share in SHARES}
    for share, insets in found.items():
        print(f"| 1/{1 / share:.0f} | " + " | ".join(f"{1000 * inset:.1f} mm" for inset in insets) + " |", flush=True)
    return found[LARGEST_SHARE]


def views_of(avatar: Avatar, clips: Sequence[Clip]) -> list[View]:
    """The most different poses of clips from all around, as one-sided texels are measured."""
    whole, views = marked(avatar, None), []
    for number, (clip, frame) in enumerate(distinct_poses(clips, avatar.encoding.rate, root=avatar.rig.skeleton.root)):
        splats = decode_clip_frame(whole, clip, frame=frame)
        mesh, drawn = mesh_of(avatar.rig, splats), tensors(splats)
        for camera in around(splats, texel_length(avatar), first=number * VIEWS):
            shares = largest_shares(drawn, Eye.of(camera, drawn.centres), torch.as_tensor(splats.bounds)).numpy()
            seen = shares >= min(SHARES)
            views.append(View(camera, mesh, on_screen(splats.centres[seen], camera), shares[seen]))
    return views


def least_inset(views: Sequence[View], share: float, lost: float) -> float:
    """Metres from which on at most this part of what is seen by this share is hidden, by bisection; MOST if never."""
    low, high = 0.0, MOST
    seen = sum(int(np.sum(view.shares >= share)) for view in views)
    for _ in range(STEPS):
        middle = (low + high) / 2
        hidden = sum(int(np.sum(view.hidden(middle) & (view.shares >= share))) for view in views)
        low, high = (low, middle) if hidden <= lost * seen else (middle, high)
    return high


def mesh_of(rig: Rig, splats: Splats) -> Mesh:
    """The posed template."""
    return Mesh(splats.mesh, normals_of(rig, splats.mesh), rig.mesh.faces, room_of(rig))


def normals_of(
    rig: Rig,
    vertices: Array,  # [V, 3]
) -> Array:
    """Unit normals [V, 3]; vertices at one place of the bind pose have one, so that seams stay closed."""
    size = float(np.ptp(rig.mesh.vertices, axis=0).max())
    places = np.round(rig.mesh.vertices / (SAME_PLACE * size))
    welded = np.unique(places, axis=0, return_inverse=True)[1].reshape(-1)
    a, b, c = np.swapaxes(vertices[rig.mesh.faces], 0, 1)
    sums = np.zeros((welded.max(initial=-1) + 1, 3))
    for corner in rig.mesh.faces.T:
        np.add.at(sums, welded[corner], np.cross(b - a, c - a))
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray((sums / np.maximum(lengths, np.finfo(float).tiny))[welded])


@cache
def room_of(rig: Rig) -> Array:
    """Half of the way [V] from each vertex inwards to the next surface of the bind pose, metres; 0 without one."""
    given = (rig.mesh.vertices, normals_of(rig, rig.mesh.vertices))
    vertices, normals = (wp.array(each.astype(np.float32), dtype=wp.vec3, device="cpu") for each in given)
    mesh = wp.Mesh(vertices, wp.array(rig.mesh.faces.reshape(-1).astype(np.int32), device="cpu"))
    depths = wp.zeros(len(rig.mesh.vertices), dtype=wp.float32, device="cpu")
    wp.launch(depths_below, dim=len(depths), inputs=[mesh.id, vertices, normals, START, depths], device="cpu")
    return np.asarray(depths.numpy() / 2)


def on_screen(points: Array, camera: Camera) -> Array:
    """Column, row and depth [N, 3] of points [N, 3]; a depth of 0 before the near plane."""
    eye = points @ camera.view[:3, :3].T + camera.view[:3, 3]
    depth = -eye[:, 2]
    ndc = eye @ camera.projection[:2, :3].T / np.maximum(depth, camera.near)[:, None]
    pixels = (ndc * [1, -1] + 1) / 2 * camera.screen
    return np.column_stack([pixels, np.where(depth > camera.near, depth, 0)]).astype(np.float32)


def behind(
    at: Array,  # [N, 3] column, row, depth
    depths: Array,  # [H, W]
) -> Array:
    """Whether each point [N] lies behind what is in the depth buffer; not beyond its edges."""
    height, width = depths.shape
    column, row = np.floor(at[:, :2]).astype(int).T
    inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    return np.asarray(inside & (at[:, 2] > depths[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]))


def tensors(splats: Splats, normals: Array | None = None) -> TorchSplats:
    given = {name: getattr(splats, name) for name in ("centres", "rotations", "scales", "opacities", "sh")}
    given |= {"turns": splats.texel_dq[:, :4]} | ({} if normals is None else {"normals": normals})
    return TorchSplats(**{name: torch.as_tensor(np.ascontiguousarray(values)) for name, values in given.items()})


def ways(avatar: Avatar, insets: Sequence[float]) -> list[Way]:
    """Nothing, the marks, the inset mesh by fragments and by splats, and both."""
    marks = [False] if avatar.rig.texels.one_sided is None else [False, True]
    found = [Way("marks" if one else "nothing", one) for one in marks]
    for inset, one in product(insets, marks):
        name = f"mesh {1000 * inset:.1f} mm deep" + (", marks" if one else "")
        found += [Way(f"{name}, by fragments", one, inset), Way(f"{name}, by splats", one, inset, whole=True)]
    return found


def print_ways(avatar: Avatar, clip: Clip, frame: int, distance: float, chosen: Sequence[Way]) -> None:
    """Print a row for each way."""
    posed = decode_clip_frame(marked(avatar, None), clip, frame=frame, dtype=np.float64)
    cameras = [eye_before(box_of(posed.centres), 2 * np.pi * side / SIDES, distance) for side in range(SIDES)]
    wanted = [exact(posed, camera) for camera in cameras]
    splats = decode_clip_frame(avatar, clip, frame=frame)
    mesh = mesh_of(avatar.rig, splats)
    for way in chosen:
        found = [drawn(splats, mesh, camera, way) for camera in cameras]
        losses = [decibels(image, reference) for (image, _, _), reference in zip(found, wanted, strict=True)]
        quads, fragments = (float(np.mean([each[index] for each in found])) for index in (1, 2))
        moved, cost = extra_bytes(mesh, way), milliseconds(quads, fragments, mesh, way)
        figures = f"{quads / 1e3:.1f} | {fragments / 1e6:.2f} | {min(losses):.1f}, {np.mean(losses):.1f}"
        row = f"{clip.name} {frame} | {distance} | {way.name} | {figures} | {moved / 1e6:.2f} | {cost:.2f}"
        print(f"| {row} |", flush=True)


def drawn(splats: Splats, mesh: Mesh, camera: Camera, way: Way) -> tuple[Array, int, int]:
    """Premultiplied sRGB and alpha [H, W, 4], how many splats are drawn, and their fragments."""
    width, height = camera.screen
    given = tensors(splats, splats.normals if way.marks else None)
    quads = project(given, Eye.of(camera, given.centres), torch.as_tensor(splats.bounds))
    at = on_screen(splats.centres[quads.splats.numpy()], camera)
    depths = np.full((height, width), NOTHING)
    if way.inset is not None:
        depths = mesh.depths(camera, way.inset)
    if way.whole:
        left = torch.as_tensor(~behind(at, depths))
        quads = Quads(quads.splats[left], quads.shapes[left], quads.colors[left])
        at, depths = at[left.numpy()], np.full_like(depths, NOTHING)
    tiles = assign(quads.shapes[:, :2], half_extents(quads.shapes), camera.screen)
    image = wp.zeros((width * height, 4), dtype=wp.float32, device="cpu")
    fragments = wp.zeros(width * height, dtype=wp.int32, device="cpu")
    listed = [tiles.places, tiles.starts, tiles.quads, quads.shapes.contiguous(), quads.colors.contiguous()]
    arrays = [*map(wp.from_torch, listed), wp.array(at[:, 2].copy()), wp.array(depths.reshape(-1))]
    threads = len(tiles.places) * TILE * TILE
    wp.launch(drawn_pixels, dim=threads, inputs=[*arrays, image, fragments], device="cpu")
    counted = int(fragments.numpy().sum(dtype=np.int64))
    return image.numpy().reshape(height, width, 4), len(quads.splats), counted


def extra_bytes(mesh: Mesh, way: Way) -> int:
    """That drawing the mesh moves for one eye."""
    if way.inset is None:
        return 0
    moved = VERTEX_BYTES * len(mesh.vertices) + TRIANGLE_BYTES * len(mesh.inset_faces(way.inset))
    return moved + (MAP_BYTES if way.whole else 0)


def milliseconds(quads: float, fragments: float, mesh: Mesh, way: Way) -> float:
    """That DEVICE would take to draw EYES, the mesh before the splats."""
    device, instructions = DEVICES[DEVICE], fragment_instructions()
    splats = drawing_ms(device, Drawn(0.0, round(TRIANGLES * quads), round(fragments), 0.0), instructions, "likely")
    triangles = 0 if way.inset is None else len(mesh.inset_faces(way.inset))
    surface, _ = drawing_ms(device, Drawn(0.0, triangles, 0, 0.0), instructions, "likely")
    moved = 1e3 * extra_bytes(mesh, way) / (1e9 * device.bandwidth * device.copy.likely)
    return EYES * (sum(splats) + surface + moved)


if __name__ == "__main__":
    main()
