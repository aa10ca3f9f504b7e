"""Tensors reach the device in the type in which the file stores them; tensors that do not fit are refused by name."""

from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.asset import write
from mua.asset.read import load
from mua.asset.tensors import Storage
from mua.errors import InputError
from mua.gpu import Device
from mua.player.buffers import AvatarBuffers

KINDS = {"f32": 0, "f16": 1, "i8": 2}


class Small:
    """A device that binds few bytes at most."""

    def __init__(self, limit: int) -> None:
        self.limit = limit

    def buffer(self, content: Array, *, name: str) -> object:
        if content.nbytes > self.limit:
            raise InputError(f"buffer {name}: {content.nbytes} bytes are more than the {self.limit}")
        return object()


def saved(directory: Path, storage: Storage) -> Path:
    path = directory / f"{storage}.muaavatar"
    write(path, synthetic_avatar(), storage=storage)
    return path


@pytest.mark.parametrize("storage", ["f32", "f16", "i8"])
def test_tensors_keep_their_bytes_and_scales(device: Device, tmp_path: Path, storage: Storage) -> None:
    path = saved(tmp_path, storage)
    tensor = load(path)["geometry"]["ll_basis"]
    basis = AvatarBuffers(device, path).geometry.ll_basis
    assert basis.layout[0] == KINDS[storage]
    content = basis.words.read().tobytes()
    assert content[: tensor["data"].size] == tensor["data"].tobytes()
    if storage == "i8":
        np.testing.assert_array_equal(basis.words.read(np.float32)[basis.layout[2] :], tensor["scale"])


def test_shapes_are_those_of_the_avatar(device: Device, tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    buffers = AvatarBuffers(device, saved(tmp_path, "f16"))
    assert (buffers.mesh.inputs, buffers.mesh.outputs) == (len(avatar.coarse.basis), avatar.coarse.mean.size)
    assert [(la.outputs, la.inputs) for la in buffers.geometry.mlp] == [la.weight.shape for la in avatar.geometry.mlp]
    for found, branch in ((buffers.geometry, avatar.geometry), (buffers.appearance, avatar.appearance)):
        assert (found.rank, *(band.rank for band in found.details)) == branch.ranks
        assert [band.size for band in found.details] == [band.mean.shape[-1] for band in branch.details]
    np.testing.assert_array_equal(buffers.rig.faces.read(), avatar.rig.mesh.faces.ravel())
    triangles, *steps = unpack_texels(buffers.rig.texels.read())
    np.testing.assert_array_equal(triangles, avatar.rig.texels.triangles)
    np.testing.assert_allclose(steps, avatar.rig.texels.barycentrics[:, :2].T, rtol=0, atol=0.5 / 0xFFFF + 1e-7)


def unpack_texels(words: Array) -> tuple[Array, Array, Array]:
    """Triangles and both barycentrics of [2 N] words."""
    triangles, packed = words.reshape(-1, 2).T
    return triangles, (packed & 0xFFFF) / 0xFFFF, (packed >> 16) / 0xFFFF


def test_a_tensor_that_the_device_cannot_bind_is_named_with_its_file(tmp_path: Path) -> None:
    path = saved(tmp_path, "f32")
    largest = synthetic_avatar().appearance.static.nbytes
    AvatarBuffers(Small(largest), path)  # type: ignore[arg-type]
    with pytest.raises(InputError, match=rf"f32\.muaavatar: buffer appearance\.static_offset: {largest} bytes"):
        AvatarBuffers(Small(largest - 1), path)  # type: ignore[arg-type]


def test_a_broken_field_is_named_with_its_file(device: Device, tmp_path: Path) -> None:
    path = saved(tmp_path, "f16")
    path.write_bytes(path.read_bytes()[:-7])
    with pytest.raises(InputError, match=r"f16\.muaavatar"):
        AvatarBuffers(device, path)
    with pytest.raises(InputError, match="none"):
        AvatarBuffers(device, tmp_path / "none")
