"""A decoder of `.muaavatar` files written from schemas/README.md and muaavatar.fbs alone; it shares no code with mua.

Everything is float64. The number at each function is that of the page's section. Plain rather than fast.
"""

import re
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pywt
from flatbuffers.table import Table

SCHEMA = Path(__file__).resolve().parents[2] / "schemas" / "muaavatar.fbs"
SCALARS = {"ubyte": "u1", "bool": "?", "ushort": "<u2", "uint": "<u4", "float": "<f4", "double": "<f8"}
ELEMENTS = ("<f4", "<f2", "i1", "<i4")  # enum ElementType
GEOMETRY = 11  # channels
C0, C1 = 0.28209479177387814, 0.4886025119029199
Tree = dict[str, Any]
Array = np.ndarray[Any, np.dtype[Any]]
Pose = tuple[Array, Array]  # l [J, 4], t [J, 3]
FIELD = re.compile(r"^\s*(\w+):\s*(\[?\w+\]?)", re.MULTILINE)
BODIES = re.findall(r"table (\w+) \{(.*?)\}", SCHEMA.read_text(), re.DOTALL)
TABLES = {name: FIELD.findall(body) for name, body in BODIES}  # fields in the order of slots


def read(path: Path) -> Tree:
    """The root table; tensors are arrays of float64 or int32, absent fields are absent."""
    content = path.read_bytes()
    return table(content, int.from_bytes(content[:4], "little"), "Avatar")


def table(content: bytes, at: int, name: str) -> Tree:
    found, here = {}, Table(content, at)
    for slot, (field, kind) in enumerate(TABLES[name]):
        offset = here.Offset(4 + 2 * slot)
        if kind in TABLES or kind == "string" or kind.startswith("["):
            found |= {field: reference(content, here, offset, kind)} if offset else {}
        else:  # an enum is a ubyte
            found[field] = np.frombuffer(content, SCALARS.get(kind, "u1"), 1, at + offset)[0] if offset else 0
    return tensor(found) if name == "Tensor" else found


def reference(content: bytes, here: Table, offset: int, kind: str) -> Any:
    if kind == "string":
        return here.String(here.Pos + offset).decode()
    if kind in TABLES:
        return table(content, here.Indirect(here.Pos + offset), kind)
    inner, start, count = kind.strip("[]"), here.Vector(offset), here.VectorLen(offset)
    if inner in SCALARS:
        return np.frombuffer(content, SCALARS[inner], count, start)
    places = [start + 4 * i for i in range(count)]
    return [here.String(p).decode() if inner == "string" else table(content, here.Indirect(p), inner) for p in places]


def tensor(fields: Tree) -> Array:
    """1.1, 1.5"""
    data = fields["data"]
    if fields.get("packing"):
        width = np.dtype(ELEMENTS[fields["type"]]).itemsize
        planes = np.frombuffer(zlib.decompress(data.tobytes(), wbits=-15), np.uint8)
        data = np.ascontiguousarray(planes.reshape(width, -1).T).reshape(-1)
    values = data.view(ELEMENTS[fields["type"]])
    if fields["type"] == 2:
        values = values * np.repeat(fields["scale"].astype(float), values.size // fields["scale"].size)
    return np.asarray(values if fields["type"] == 3 else values.astype(float)).reshape(fields["shape"])


def times(p: Array, q: Array) -> Array:
    """1.2: the Hamilton product."""
    pw, px, py, pz = np.moveaxis(p, -1, 0)
    qw, qx, qy, qz = np.moveaxis(q, -1, 0)
    w, x = pw * qw - px * qx - py * qy - pz * qz, pw * qx + px * qw + py * qz - pz * qy
    return np.stack([w, x, pw * qy - px * qz + py * qw + pz * qx, pw * qz + px * qy - py * qx + pz * qw], axis=-1)


def conjugate(q: Array) -> Array:
    return np.asarray(q * [1, -1, -1, -1])


def pure(v: Array) -> Array:
    return np.concatenate([np.zeros_like(v[..., :1]), v], axis=-1)


def rotate(q: Array, v: Array) -> Array:
    return times(times(q, pure(v)), conjugate(q))[..., 1:]


def rigid(q: Array, t: Array) -> Array:
    """1.3"""
    return np.concatenate([q, 0.5 * times(pure(t), q)], axis=-1)


def chained(a: Array, b: Array) -> Array:
    r, d, r2, d2 = a[..., :4], a[..., 4:], b[..., :4], b[..., 4:]
    return np.concatenate([times(r, r2), times(r, d2) + times(d, r2)], axis=-1)


def apply(a: Array, p: Array) -> Array:
    return rotate(a[..., :4], p) + 2 * times(a[..., 4:], conjugate(a[..., :4]))[..., 1:]


def unit(q: Array) -> Array:
    return np.asarray(q / np.maximum(np.linalg.norm(q, axis=-1, keepdims=True), np.finfo(float).tiny))


@dataclass(frozen=True)
class Splats:
    canonical: Array  # v [V, 3]
    dual: Array  # Q [N, 8]
    centres: Array  # [N, 3]
    rotations: Array  # [N, 4]
    scales: Array  # [N, 3]
    opacities: Array  # [N]
    sh: Array  # [N, 4, 3] c0 ... c3
    root: Array  # [3] P[root]

    def colours(self, camera: Array) -> Array:
        """6.6: [N, 3] towards a camera [3]."""
        away = self.centres - camera
        away = away / np.linalg.norm(away, axis=1, keepdims=True)
        x, y, z = rotate(conjugate(self.dual[:, :4]), away).T[..., None]
        c0, c1, c2, c3 = np.moveaxis(self.sh, 1, 0)
        return np.asarray(np.maximum(0.5 + C0 * c0 + C1 * (-y * c1 + z * c2 - x * c3), 0))


def poses(avatar: Tree, clip: Tree) -> list[Pose]:
    """2.2, 2.3: the frames of a clip at the rate of the encoding."""
    skeleton, rotations = avatar["skeleton"], unit(clip["rotations"])
    translations = np.tile(skeleton["bind_translations"], (len(rotations), 1, 1))
    translations[:, skeleton["root"]] = clip["translation"]
    if "translated" in skeleton:
        translations[:, skeleton["translated"]] = clip["translations"]
    last, f, g = len(rotations) - 1, avatar["encoding"]["rate"], clip["rate"]
    found = []
    for n in range(int(np.floor(last * f / g + 1e-6)) + 1):
        u = min(n * g / f, last)
        a, s = int(u), u - int(u)
        b = min(a + 1, last)
        found.append((slerp(rotations[a], rotations[b], s), (1 - s) * translations[a] + s * translations[b]))
    return found


def slerp(first: Array, second: Array, s: float) -> Array:
    dot = np.sum(first * second, axis=1, keepdims=True)
    second, angle = np.where(dot < 0, -second, second), np.arccos(np.minimum(np.abs(dot), 1))
    with np.errstate(invalid="ignore"):
        along = (np.sin((1 - s) * angle) * first + np.sin(s * angle) * second) / np.sin(angle)
    return unit(np.where(angle < 1e-6, (1 - s) * first + s * second, along))


def world(skeleton: Tree, pose: Pose) -> tuple[Array, Array]:
    """2.4: W [J, 4] and P [J, 3]."""
    turned, placed = (a.copy() for a in pose)
    for j, p in enumerate(skeleton["parents"]):
        if p >= 0:
            turned[j] = times(turned[p], turned[j])
            placed[j] = placed[p] + rotate(turned[p], placed[j])
    return turned, placed


def six(q: Array) -> Array:
    """3.3"""
    w, x, y, z = np.moveaxis(q, -1, 0)
    first = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]
    return np.stack([*first, 2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)


def descriptor(avatar: Tree, window: list[Pose]) -> Array:
    """3.2, 3.4, 3.5: z [K]; `window` is newest first."""
    skeleton, encoding = avatar["skeleton"], avatar["encoding"]
    root, bind = skeleton["root"], (unit(skeleton["bind_rotations"]), skeleton["bind_translations"])  # 2.1
    bound = world(skeleton, bind)[0]
    placed = [world(skeleton, pose) for pose in window]
    turns = [times(turned, conjugate(bound)) for turned, _ in placed]
    twist = turns[0][root] * [1, 0, 1, 0]
    heading = unit(twist) if encoding["heading"] and np.linalg.norm(twist) >= 1.5e-8 else np.eye(4)[0]
    back = conjugate(heading)
    numbers = [six(times(back, turns[0][j])) for j in encoding["joints"]]
    for (local, moved), turn, (_, places) in zip(window, turns, placed, strict=True):
        numbers += [rotate(back, places[root] - placed[0][1][root]), six(times(back, turn[root]))]
        numbers += [six(local[j]) for j in encoding["joints"]]
        numbers += [moved[j] - bind[1][j] for j in encoding.get("translated", ())]
    return np.asarray(encoding["components"] @ ((np.concatenate(numbers) - encoding["mean"]) / encoding["scale"]))


def bounded(avatar: Tree, z: Array) -> Array:
    """3.6: x [K]"""
    (low, high), m, x = avatar["encoding"]["ranges"], avatar["encoding"]["margins"], z.copy()
    for k in range(len(z)):
        if z[k] > high[k]:
            x[k] = high[k] + (z[k] - high[k]) * m[k] / (z[k] - high[k] + m[k])
        elif z[k] < low[k]:
            x[k] = low[k] - (low[k] - z[k]) * m[k] / (low[k] - z[k] + m[k])
    return x


def outside(avatar: Tree, z: Array) -> float:
    """3.7"""
    length = float(np.linalg.norm(z))
    return float(np.linalg.norm(z - bounded(avatar, z))) / length if length else 0.0


def mlp(layers: list[Tree], x: Array) -> Array:
    """4.1"""
    for i, layer in enumerate(layers):
        x = layer["weight"] @ x + layer["bias"]
        x = x if i == len(layers) - 1 else np.maximum(x, 0)
    return x


def branch_texture(avatar: Tree, branch: Tree, x: Array) -> Array:
    """4.3, 5: channels [C, N] at the valid texels."""
    wavelet, texels = avatar["wavelet"], avatar["texels"]
    channels, rank = branch["ll_basis"].shape[:2]
    ranks = [rank, *(band["h"].shape[2] for band in branch["details"])]
    parts = np.split(mlp(branch["mlp"], x), channels * np.cumsum(ranks)[:-1])
    low, *high = (part.reshape(channels, rank) for part, rank in zip(parts, ranks, strict=True))
    image = branch["ll_mean"] + np.einsum("cr,crij->cij", low, branch["ll_basis"])
    filters = pywt.Wavelet("file", filter_bank=[wavelet["rec_lo"], wavelet["rec_hi"]] * 2)  # the last two are used
    zeros = [(None, None, None)] * (wavelet["levels"] - len(high))
    pairs = zip(high, branch["details"], strict=True)
    details = [b["mean"] + np.einsum("cr,scri,scrj->scij", alpha, b["h"], b["w"]) for alpha, b in pairs]
    image = pywt.waverec2([image, *map(tuple, details), *zeros], filters, mode="periodization", axes=(1, 2))
    for _ in range(avatar.get("level", 0)):  # 9.6
        image = (image[:, ::2, ::2] + image[:, ::2, 1::2] + image[:, 1::2, ::2] + image[:, 1::2, 1::2]) / 4
    rows, columns = np.divmod(texels["texels"], texels["size"])
    return np.asarray(image[:, rows, columns] + branch["static_offset"])


def places(template: Tree, texels: Tree) -> Array:
    """5.5: b_0 and b_1 [N, 2]."""
    if "listed" not in texels:
        return np.asarray(texels["barycentrics"])
    found = []
    for texel, triangle in zip(texels["texels"], texels["triangles"], strict=True):
        row, col = divmod(int(texel), int(texels["size"]))
        corners = template["uv"][template["uv_faces"][triangle]] * float(texels["size"]) - [col + 0.5, row + 0.5]
        (x0, y0), (x1, y1), (x2, y2) = corners
        areas = (x1 * y2 - y1 * x2, x2 * y0 - y2 * x0, x0 * y1 - y0 * x1)
        whole = sum(areas) or np.inf  # the texel is listed
        first = np.float32(min(max(areas[0] / whole, 0), 1))
        found.append((first, np.float32(min(max(areas[1] / whole, 0), 1 - float(first)))))
    two = np.array(found).reshape(-1, 2).astype(float)
    two[texels["listed"]] = texels["barycentrics"]
    return two


def one_sided(texels: Tree) -> Array:
    """5.6: [N] bool."""
    content = texels.get("one_sided", bytes(-(-len(texels["texels"]) // 8)))
    return np.array([int(content[e // 8]) >> e % 8 & 1 for e in range(len(texels["texels"]))], dtype=bool)


def blend(duals: Array, weights: Array, references: Array) -> Array:
    """6.2: of duals [N, K, 8] by weights [N, K]; references [N, 8]."""
    signs = np.where(np.einsum("nki,ni->nk", duals[..., :4], references[:, :4]) < 0, -1, 1)
    total = np.einsum("nk,nki->ni", weights * signs, duals)
    return np.asarray(total / np.maximum(np.linalg.norm(total[:, :4], axis=1), np.finfo(float).tiny)[:, None])


def decode(avatar: Tree, frames: list[Pose], n: int) -> Splats:
    """Frame n of poses at the rate of the encoding: 3 to 6."""
    skeleton, template, texels = avatar["skeleton"], avatar["template"], avatar["texels"]
    window = [frames[max(n - age, 0)] for age in range(avatar["encoding"]["window"])]  # 3.1
    x = bounded(avatar, descriptor(avatar, window))
    coarse = avatar["coarse"]
    canonical = coarse["mean"] + np.einsum("k,kvi->vi", mlp(coarse["mlp"], x), coarse["basis"])  # 4.2
    texture = np.concatenate([branch_texture(avatar, avatar[name], x) for name in ("geometry", "appearance")]).T
    turned, placed = world(skeleton, frames[n])
    joints = chained(rigid(turned, placed), skeleton["bind_inverse"])  # 6.1
    indices = template["skin_indices"]
    vertices = blend(joints[indices], template["skin_weights"], joints[indices[:, 0]])  # 6.3
    two = places(template, texels)
    weights = np.column_stack([two, np.maximum(1 - two.sum(axis=1), 0)])
    corners = template["faces"][texels["triangles"]]
    nearest = corners[np.arange(len(corners)), np.argmax(weights, axis=1)]
    dual = blend(vertices[corners], weights, vertices[nearest])  # 6.4
    return Splats(  # 6.5
        canonical=canonical,
        dual=dual,
        centres=apply(dual, np.einsum("nk,nki->ni", weights, canonical[corners]) + texture[:, 0:3]),
        rotations=times(dual[:, :4], unit(texture[:, 3:7])),
        scales=np.exp(np.minimum(texture[:, 7:10], 10)),
        opacities=1 / (1 + np.exp(-texture[:, 10])),
        sh=texture[:, GEOMETRY:].reshape(-1, 4, 3),
        root=placed[skeleton["root"]],
    )


def behind(avatar: Tree, splats: Splats, view: Array) -> Array:
    """7.2: [N] whether an eye sees a one-sided texel from behind."""
    corners = splats.canonical[avatar["template"]["faces"][avatar["texels"]["triangles"]]]
    normal = rotate(splats.dual[:, :4], np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    away = splats.centres + view[:3, :3].T @ view[:3, 3]
    sizes = np.linalg.norm(normal, axis=1) * np.linalg.norm(away, axis=1)
    return np.asarray(one_sided(avatar["texels"]) & (np.sum(normal * away, axis=1) > 0.25 * sizes))


def keys(avatar: Tree, splats: Splats, view: Array, near: float) -> Array:
    """7.3: the smaller, the earlier drawn; one avatar where its clip puts it, one eye."""
    low, high = avatar["bounds"] + splats.root
    corners = np.array([[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)])
    depths, box = (-(points @ view[2, :3] + view[2, 3]) for points in (splats.centres, corners))
    nearest, farthest = (end(box) + s * np.linalg.norm(high - low) / 2 for end, s in ((np.min, -1), (np.max, 1)))
    return np.floor(65534 * np.clip((farthest - depths) / (farthest - max(nearest, near)), 0, 1) + 0.5)
