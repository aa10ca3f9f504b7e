"""An avatar's tensors on the device, in the type in which the file stores them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.flatbuffer import FormatError, Tree
from mua.asset.read import decode_tree, load
from mua.asset.tensors import pack
from mua.avatar.coarser import at_level
from mua.avatar.model import Model
from mua.errors import InputError
from mua.gpu import Buffer, Device
from mua.gpu.tensor_words import Layout, upload_words
from mua.kernels.expressions import Targets, by_vertex, pack_entries, reach_of
from mua.kernels.inverse_dwt import texel_tiles, upsampling_taps, whole_words
from mua.kernels.splat_project import pack_texels
from mua.rig.expressions import Expressions
from mua.rig.rig import Rig

T = TypeVar("T")
BRANCHES = ("geometry", "appearance")
NO_EXPRESSIONS = Expressions((), np.zeros(1, np.int32), np.zeros(0, np.int32), np.zeros((0, 3), np.float32))


@dataclass(frozen=True)
class StoredBuffer:
    """A tensor as the kernels' `stored()` reads it."""

    words: Buffer
    layout: Layout


@dataclass(frozen=True)
class LayerBuffers:
    """One fully connected layer, or the PCA mesh as one."""

    weight: StoredBuffer
    bias: StoredBuffer
    inputs: int
    outputs: int


@dataclass(frozen=True)
class BandBuffers:
    """The three detail subbands of one level."""

    mean: StoredBuffer
    h: StoredBuffer
    w: StoredBuffer
    rank: int
    size: int  # texels along a side


@dataclass(frozen=True)
class UpsamplingBuffers:
    """The filter that a branch's levels without details are together (mua.kernels.inverse_dwt.upsampling_taps)."""

    taps: Buffer
    factor: int  # texels along a side for each sample
    reach: int  # samples along a side that a texel needs
    delay: int  # delay of the filter, texels


@dataclass(frozen=True)
class BranchLevel:
    """The part of a level that belongs to geometry or appearance alone."""

    upsampling: UpsamplingBuffers
    static_offset: StoredBuffer


@dataclass(frozen=True)
class BranchBuffers:
    """Geometry or appearance; sizes are those of mua.asset.avatar.Branch."""

    mlp: tuple[LayerBuffers, ...]
    ll_mean: StoredBuffer
    ll_basis: StoredBuffer
    details: tuple[BandBuffers, ...]  # coarse first
    channels: int
    rank: int  # rank of LL


@dataclass(frozen=True)
class RigPlaces:
    """The places of a rig's texels on its mesh."""

    faces: Buffer  # [F, 3]
    texels: Buffer  # [N, 2] words (mua.kernels.splat_project.pack_texels)


@dataclass(frozen=True)
class RigBuffers(RigPlaces):
    """The places of the texels, and the tensors that pose the vertices."""

    skin_indices: Buffer  # [V, 8]
    skin_weights: Buffer  # [V, 8]


@dataclass(frozen=True)
class ExpressionBuffers:
    """What moves each vertex that any expression moves, and what it may bend (mua.kernels.expressions)."""

    vertices: Buffer  # [M]
    starts: Buffer  # [M + 1]
    expressions: Buffer  # [P] of 16 bits
    changes: Buffer  # [P, 4] half floats
    vertex_count: int  # M
    corners: Buffer  # [T, 3] vertices of the triangles in reach of these
    triangle_count: int  # T
    bent_vertices: Buffer  # [B] all of them
    star_starts: Buffer  # [B + 1]
    stars: Buffer  # [3 T]
    bent_count: int  # B


@dataclass(frozen=True)
class LevelBuffers:
    """The texels of one level of detail (mua.avatar.coarser)."""

    number: int  # 0 is the finest
    size: int  # texels along a side
    splat_count: int
    places: RigPlaces
    tile_count: int
    tiles: Buffer  # from mua.kernels.inverse_dwt.texel_tiles
    reached: int  # how many texels expressions may change
    geometry: BranchLevel
    appearance: BranchLevel


def upload_rig(device: Device, rig: Rig) -> RigBuffers:
    """Upload a rig. Errors: InputError where a buffer is larger than the device can bind or hold."""
    return RigBuffers(
        faces=device.buffer(rig.mesh.faces.astype(np.uint32), name="template.faces"),
        texels=device.buffer(
            pack_texels(rig.texels.triangles, rig.texels.barycentrics, rig.texels.one_sided), name="texels"
        ),
        skin_indices=device.buffer(rig.skin_indices.astype(np.uint32), name="template.skin_indices"),
        skin_weights=device.buffer(rig.skin_weights.astype(np.float32), name="template.skin_weights"),
    )


def upload_targets(device: Device, targets: Targets, faces: Array) -> ExpressionBuffers:
    """Upload expressions. Errors: InputError where a buffer is larger than the device can bind or hold."""
    reach = reach_of(targets.vertices, faces, np.zeros(0, np.int32))
    expressions, changes = pack_entries(targets)
    return ExpressionBuffers(
        vertices=device.buffer(targets.vertices.astype(np.uint32), name="expressions.vertices"),
        starts=device.buffer(targets.starts.astype(np.uint32), name="expressions.starts"),
        expressions=device.buffer(expressions, name="expressions.vertices"),
        changes=device.buffer(changes, name="expressions.offsets"),
        vertex_count=len(targets.vertices),
        corners=device.buffer(reach.corners.astype(np.uint32), name="expressions.vertices"),
        triangle_count=len(reach.corners),
        bent_vertices=device.buffer(reach.vertices.astype(np.uint32), name="expressions.vertices"),
        star_starts=device.buffer(reach.starts.astype(np.uint32), name="expressions.vertices"),
        stars=device.buffer(reach.stars.astype(np.uint32), name="expressions.vertices"),
        bent_count=len(reach.vertices),
    )


class AvatarBuffers:
    """The data of a file that is the same in all frames; `avatar` is the file on the CPU."""

    def __init__(self, device: Device, path: Path) -> None:
        """Upload the file at `path`.

        Errors: InputError naming the file where it is broken, or where a tensor is more than the device can bind.
        """
        tree = load(path)
        try:
            self.avatar: Avatar = decode_tree(tree)
        except FormatError as error:
            raise error.inside(str(path)) from error
        self._device, self._path = device, path
        rig = self.avatar.rig
        self.coarse_mlp = self._mlp(tree["coarse"]["mlp"], "coarse.mlp")
        self.mesh = self._mesh(tree["coarse"])
        self.geometry = self._branch(tree, "geometry")
        self.appearance = self._branch(tree, "appearance")
        lo, hi = (whole_words(taps) for taps in (self.avatar.wavelet.rec_lo, self.avatar.wavelet.rec_hi))
        self.rec_lo = self._upload(lo.astype(np.float32), "wavelet.rec_lo")
        self.rec_hi = self._upload(hi.astype(np.float32), "wavelet.rec_hi")
        self.taps = len(lo)  # of geometry and appearance
        self.rig = self._named(lambda: upload_rig(device, rig))
        held = NO_EXPRESSIONS if rig.expressions is None else rig.expressions
        self._targets = by_vertex(held.starts, held.vertices, held.changes)
        self.expressions = self._named(lambda: upload_targets(device, self._targets, rig.mesh.faces))
        stored = {name: self._stored(tree[name]["static_offset"], f"{name}.static_offset") for name in BRANCHES}
        self._levels = [self._level(self.avatar, self.rig, stored)]
        self._coarser: Model = self.avatar  # from which the last level was made

    def level(self, number: int) -> LevelBuffers:
        """A level of detail, at most mua.avatar.coarser.coarsest of the avatar; made when it is first asked for.

        Errors: InputError naming the file, where a tensor is more than the device can bind.
        """
        while len(self._levels) <= number:
            self._coarser = at_level(self._coarser, 1)
            texels = self._coarser.rig.texels
            words = pack_texels(texels.triangles, texels.barycentrics, texels.one_sided)
            places = RigPlaces(self.rig.faces, self._upload(words, "texels"))
            statics = {name: self._packed(getattr(self._coarser, name).static, name) for name in BRANCHES}
            self._levels.append(self._level(self._coarser, places, statics))
        return self._levels[number]

    def _level(self, avatar: Model, places: RigPlaces, statics: Mapping[str, StoredBuffer]) -> LevelBuffers:
        texels, coarser = avatar.rig.texels, avatar.wavelet.coarser
        reached = reach_of(self._targets.vertices, avatar.rig.mesh.faces, texels.triangles).texels
        tiles = texel_tiles(texels.texels, texels.size, reached)
        geometry, appearance = (
            BranchLevel(self._upsampling(len(getattr(avatar, name).details), coarser), statics[name])
            for name in BRANCHES
        )
        return LevelBuffers(
            number=coarser,
            size=texels.size,
            splat_count=len(texels.texels),
            places=places,
            tile_count=len(tiles),
            tiles=self._upload(tiles, "texels.texels"),
            reached=int(reached.sum()),
            geometry=geometry,
            appearance=appearance,
        )

    def _packed(self, static: Array, name: str) -> StoredBuffer:
        return self._stored(pack(static), f"{name}.static_offset")

    def _mlp(self, layers: list[Tree], path: str) -> tuple[LayerBuffers, ...]:
        return tuple(self._layer(layer, f"{path}[{i}]") for i, layer in enumerate(layers))

    def _layer(self, layer: Tree, path: str) -> LayerBuffers:
        outputs, inputs = (int(n) for n in layer["weight"]["shape"])
        weight = self._stored(layer["weight"], f"{path}.weight")
        return LayerBuffers(weight, self._stored(layer["bias"], f"{path}.bias"), inputs, outputs)

    def _mesh(self, coarse: Tree) -> LayerBuffers:
        """Canonical vertices as a layer whose weight lies transposed: the basis [K, 3 V], the mean [3 V]."""
        basis = self._stored(coarse["basis"], "coarse.basis")
        rank, vertices, _ = (int(n) for n in coarse["basis"]["shape"])
        return LayerBuffers(basis, self._stored(coarse["mean"], "coarse.mean"), rank, 3 * vertices)

    def _branch(self, tree: Tree, name: str) -> BranchBuffers:
        branch = tree[name]
        expanded = getattr(self.avatar, name)
        return BranchBuffers(
            mlp=self._mlp(branch["mlp"], f"{name}.mlp"),
            ll_mean=self._stored(branch["ll_mean"], f"{name}.ll_mean"),
            ll_basis=self._stored(branch["ll_basis"], f"{name}.ll_basis"),
            details=tuple(self._band(band, f"{name}.details[{i}]") for i, band in enumerate(branch["details"])),
            channels=expanded.channels,
            rank=expanded.ranks[0],
        )

    def _band(self, band: Tree, path: str) -> BandBuffers:
        mean, h, w = (self._stored(band[key], f"{path}.{key}") for key in ("mean", "h", "w"))
        rank, size = (int(n) for n in band["h"]["shape"][2:])
        return BandBuffers(mean, h, w, rank, size)

    def _upsampling(self, dynamic: int, coarser: int) -> UpsamplingBuffers:
        """The upsampling filter of the levels after the `dynamic` ones, which have details."""
        wavelet = self.avatar.wavelet
        taps, delay = upsampling_taps(wavelet.rec_lo, wavelet.levels - dynamic, coarser)
        reach, factor = taps.shape
        return UpsamplingBuffers(self._upload(taps.astype(np.float32), "wavelet.rec_lo"), factor, reach, delay)

    def _stored(self, tensor: Tree, field: str) -> StoredBuffer:
        words, layout = upload_words(tensor)
        return StoredBuffer(self._upload(words, field), layout)

    def _upload(self, content: Array, field: str) -> Buffer:
        return self._named(lambda: self._device.buffer(content, name=field))

    def _named(self, upload: Callable[[], T]) -> T:
        try:
            return upload()
        except InputError as error:
            raise InputError(f"{self._path}: {error}") from error
