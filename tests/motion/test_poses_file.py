"""Poses of one skeleton come back from an .npz as they were."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar

from mua.errors import InputError
from mua.motion.poses_file import holds_poses, read_poses, write_poses
from mua.motion.read import read_motion

AVATAR = synthetic_avatar()
CLIP = AVATAR.clips[0]
SKELETON = replace(AVATAR.rig.skeleton, root=1)  # as of rigs that stand on a joint of their own


def test_comes_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "walk.npz"
    write_poses(path, SKELETON, replace(CLIP, rate=24.0))
    assert holds_poses(path)
    for found in (read_poses(path), read_motion(path)[0]):
        assert (found.skeleton.names, found.skeleton.root) == (SKELETON.names, 1)
        assert (found.clip.name, found.clip.rate) == ("walk", 24.0)
        for name in ("parents", "bind_rotations", "bind_translations"):
            np.testing.assert_allclose(getattr(found.skeleton, name), getattr(SKELETON, name), atol=1e-12)
        np.testing.assert_allclose(found.clip.rotations, CLIP.rotations, atol=1e-6)
        np.testing.assert_array_equal(found.clip.translations, CLIP.translations)


def test_a_file_that_cannot_be_replaced_stays_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "walk.npz"
    write_poses(path, SKELETON, CLIP)
    before = path.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(InputError, match=r"walk\.npz"):
        write_poses(path, SKELETON, CLIP.cut(np.array([0])))
    assert path.read_bytes() == before
