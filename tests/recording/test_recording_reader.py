"""Recordings read back: their values, and errors for damaged ones."""

import json
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
import pywt
import torch
from recordings import RATE, FormulaTeacher, aligned, content, opened, plan, truth, write
from synthetic_avatar import synthetic_rig

from mua.arrays import Array
from mua.channels import GEOMETRY
from mua.errors import InputError
from mua.recording import Recording
from mua.texture.fill import Fill

HALF = 2.0**-11  # relative rounding error of half precision
SUBNORMAL = 2.0**-25  # its absolute error next to zero
SINGLE = float(np.finfo(np.float32).eps)
TRANSFORM = 4 * 2 * 10 * SINGLE  # four levels, two axes, ten taps


def test_clips_and_poses_come_back_exactly(written: Path) -> None:
    recording = Recording(written)
    assert recording.rate == RATE
    assert recording.wavelet == "spline3"
    for stored, planned in zip(recording.clips, plan(synthetic_rig()), strict=True):
        assert (stored.name, stored.held_out, stored.complete) == (planned.clip.name, planned.held_out, True)
        assert stored.recorded.tolist() == sorted(planned.wanted)
        np.testing.assert_array_equal(stored.rotations, planned.clip.rotations)
        np.testing.assert_array_equal(stored.translations, planned.clip.translations)


def test_rig_comes_back_exactly(written: Path) -> None:
    stored, rig = Recording(written).rig, synthetic_rig()
    assert (stored.skeleton.names, stored.skeleton.root) == (rig.skeleton.names, rig.skeleton.root)
    np.testing.assert_array_equal(stored.mesh.vertices, rig.mesh.vertices)
    np.testing.assert_array_equal(stored.skin_weights, rig.skin_weights)
    np.testing.assert_array_equal(stored.texels.barycentrics, rig.texels.barycentrics)
    assert stored.texels.size == rig.texels.size


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs Linux, which says what a process maps")
def test_what_was_read_does_not_stay_in_memory(written: Path) -> None:
    recording = Recording(written)
    recording.subbands(GEOMETRY, range(recording.count()))
    recording.meshes(range(recording.count()))
    recording.mean_mesh()
    recording.mean_texture()
    assert sum(1 for _ in recording.whole_frames())
    resident: dict[str, int] = {}
    name = ""
    for line in Path("/proc/self/smaps").read_text().splitlines():
        if line.endswith(".npy"):
            name = Path(line.split(maxsplit=5)[5]).name
        elif line.startswith("Rss:") and name:
            resident[name] = resident.get(name, 0) + int(line.split()[1])
            name = ""
    assert {name: size for name, size in resident.items() if size} == {}
    kept = {"meshes.npy", "ll.npy", "d3.npy", "d2.npy", "rotations.npy", "translations.npy", "sum.npy"}
    assert kept <= set(resident)


def pywt_subbands(fill: Fill, texture: Array) -> list[Array]:
    """LL [C, n, n], D3 and D2 [3, C, ., .] of a filled texture, in double precision."""
    image = fill(torch.from_numpy(texture)).numpy().astype(np.float64)
    bands = []
    for _ in range(4):
        image, details = pywt.dwt2(image, "bior4.4", "periodization")
        bands.append(np.stack(details))
    return [image, bands[3], bands[2]]


@pytest.mark.parametrize("held_out", [False, True])
def test_subbands_are_within_half_precision_of_the_difference(tmp_path: Path, held_out: bool) -> None:
    write(tmp_path, wavelet="bior4.4")
    recording = Recording(tmp_path)
    frames, reference = truth(held_out=held_out), truth(held_out=False)[0].texture
    rows = list(range(recording.count(held_out)))[::-1]
    assert len(rows) == len(frames)
    stored = {part: recording.subbands(slice(*part), rows, held_out=held_out) for part in ((0, 11), (11, 23), (4, 5))}
    fill = Fill(recording.rig.texels)
    for at, row in enumerate(rows):
        expected = pywt_subbands(fill, frames[row].texture)
        changes = pywt_subbands(fill, frames[row].texture - reference)
        for (start, stop), bands in stored.items():
            for band, whole, change in zip(bands, expected, changes, strict=True):
                assert band.dtype == torch.float32
                error = np.abs(band[at].numpy() - whole[..., start:stop, :, :])
                bound = HALF * np.abs(change[..., start:stop, :, :]) + SUBNORMAL + TRANSFORM * np.abs(whole).max()
                assert (error <= bound).all()


def test_meshes_come_back_exactly(written: Path) -> None:
    recording = Recording(written)
    expected = np.stack([frame.mesh for frame in truth(held_out=False)])
    np.testing.assert_array_equal(recording.meshes(torch.arange(recording.count())), expected)
    np.testing.assert_array_equal(recording.meshes([3, 1, 3]), expected[[3, 1, 3]])
    assert recording.meshes([]).shape == (0, *expected.shape[1:])
    assert recording.subbands(GEOMETRY, []).d2.shape == (0, 3, 11, 4, 4)


def test_means_are_over_training_frames_only(written: Path) -> None:
    recording, frames = Recording(written), truth(held_out=False)
    mean = np.mean([frame.texture for frame in frames], axis=0, dtype=np.float64)
    largest = max(float(np.abs(frame.texture).max()) for frame in frames)
    np.testing.assert_allclose(recording.mean_texture(), mean, rtol=0, atol=SINGLE * 2 * largest)
    mesh = np.mean([frame.mesh for frame in frames], axis=0, dtype=np.float64)
    np.testing.assert_allclose(recording.mean_mesh(), mesh, rtol=1e-14, atol=1e-14)


def test_whole_frames_are_those_planned_or_every_nth(written: Path) -> None:
    recording = Recording(written)
    kept = [(frame.clip.name, frame.index) for frame in recording.whole_frames()]
    assert kept == [("walk", 0), ("walk", 10), ("walk", 20), ("turn", 4), ("reach", 2), ("reach", 3)]
    assert recording.whole_count == len(kept)
    assert [frame.clip.name for frame in recording.whole_frames(held_out=True)] == ["turn"]
    teacher = FormulaTeacher(recording.rig)
    reference = truth(held_out=False)[0].texture
    for frame in recording.whole_frames():
        original = teacher.frame(frame.clip, frame.index)
        expected = aligned(original.texture, reference)
        bound = HALF * np.abs(expected - reference) + SUBNORMAL + 2 * SINGLE * np.abs(expected)
        assert (np.abs(frame.texture - expected) <= bound).all()
        np.testing.assert_array_equal(frame.mesh, original.mesh)


def test_fingerprint_changes_with_reference_and_header(written: Path, tmp_path: Path) -> None:
    """Shards hold differences: the same ones from another reference, or at another rate, are other frames."""
    found = [Recording(written).fingerprint()]
    shutil.copytree(written, tmp_path / "reference")
    path = tmp_path / "reference" / "reference.npz"
    arrays = dict(np.load(path))
    np.savez(path, **{name: array + array.dtype.type(1) for name, array in arrays.items()})
    shutil.copytree(written, tmp_path / "rate")
    header = json.loads((written / "recording.json").read_text())
    (tmp_path / "rate" / "recording.json").write_text(json.dumps(header | {"rate": 30.0}))
    found += [Recording(tmp_path / changed).fingerprint() for changed in ("reference", "rate")]
    assert len(set(found)) == 3


def test_fingerprint_changes_with_content_only(written: Path, tmp_path: Path) -> None:
    write(tmp_path / "again")
    assert Recording(tmp_path / "again").fingerprint() == Recording(written).fingerprint()
    assert content(tmp_path / "again") == content(written)
    write(tmp_path / "other", whole_every=3)
    assert Recording(tmp_path / "other").fingerprint() != Recording(written).fingerprint()


def test_recording_without_frames_opens_but_has_no_mean(tmp_path: Path) -> None:
    with opened(tmp_path) as writer:
        writer.start_clip("walk")
        writer.add(synthetic_rig().skeleton.bind_pose)
    recording = Recording(tmp_path)
    assert (recording.count(), len(recording.clips[0])) == (0, 1)
    with pytest.raises(InputError, match="holds no training frame"):
        recording.mean_texture()


@pytest.fixture
def copy(written: Path, tmp_path: Path) -> Path:
    """A recording that may be damaged."""
    return Path(shutil.copytree(written, tmp_path / "copy"))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("recording.json", "holds no recording.json"),
        ("rig.npz", r"rig\.npz"),
        ("reference.npz", r"reference\.npz: is missing"),
        ("shards/00001/index.json", r"00001/index\.json: is missing"),
        ("shards/00001/d2.npy", r"00001/d2\.npy is missing"),
        ("shards/00000/whole_00000.npy", r"00000/whole_00000\.npy is missing"),
        ("shards/00006/sum.npy", r"sum\.npy is missing"),
    ],
)
def test_names_a_missing_file(copy: Path, name: str, message: str) -> None:
    (copy / name).unlink()
    with pytest.raises(InputError, match=message):
        Recording(copy)


def test_names_a_missing_shard(copy: Path) -> None:
    shutil.rmtree(copy / "shards/00001")
    for use in (Recording, opened):
        with pytest.raises(InputError, match="shard 00001 is missing"):
            use(copy)


@pytest.mark.parametrize(
    "name", ["recording.json", "rig.npz", "reference.npz", "shards/00001/index.json", "shards/00001/ll.npy"]
)
def test_names_a_file_cut_short(copy: Path, name: str) -> None:
    path = copy / name
    whole = path.read_bytes()
    for kept in (0, 1, len(whole) // 3, len(whole) - 2):
        path.write_bytes(whole[:kept])
        with pytest.raises(InputError, match=path.name):
            Recording(copy)


def test_refuses_a_newer_version(copy: Path) -> None:
    header = json.loads((copy / "recording.json").read_text())
    (copy / "recording.json").write_text(json.dumps(header | {"version": 3}))
    with pytest.raises(InputError, match="version is 3, this program reads 2"):
        Recording(copy)
