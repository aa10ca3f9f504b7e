"""What compared systems are given: maps of the posed surface, and motion that was held out."""

import numpy as np
import pytest
import torch
from compared_systems import HELD_OUT, SETTINGS, STEPS, trained
from synthetic_avatar import synthetic_rig

from mua import rotation
from mua.channels import APPEARANCE, GEOMETRY
from mua.pose.clip import Clip
from mua.recording import Recording
from mua.rig.bones import PERSON
from mua.student.distil import prepare
from mua.student.targets import channel_weights
from mua_research.maps import SurfaceMaps
from mua_research.motion import band_statistics, motion_of, pose_about_root
from mua_research.system import Budget, TrainingFrames


@pytest.mark.parametrize("size", [2, 7, 16])
def test_maps_equal_an_independent_sampling(size: int) -> None:
    rig = synthetic_rig()
    rng = np.random.default_rng(size)
    posed = rig.mesh.vertices + 0.05 * rng.standard_normal(rig.mesh.vertices.shape)
    found = SurfaceMaps(rig, size, device=torch.device("cpu"))(torch.from_numpy(posed).float()[None])[0]
    normals = np.zeros_like(posed)
    for face in rig.mesh.faces:
        a, b, c = posed[face]
        normals[face] += np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    seen = 0
    for row, column in np.ndindex(size, size):
        centre = np.array([column + 0.5, row + 0.5, size]) / size  # u, v, 1
        for face, uv_face in zip(rig.mesh.faces, rig.mesh.uv_faces, strict=True):
            corners = np.vstack([rig.mesh.uv[uv_face].T, np.ones(3)])
            weights = np.linalg.solve(corners, centre)
            if (weights > 1e-9).all():
                normal = weights @ normals[face]
                expected = [*(weights @ posed[face]), *(normal / np.linalg.norm(normal))]
                np.testing.assert_allclose(found[:, row, column], expected, rtol=0, atol=1e-5)
                seen += 1
    assert seen >= size * size // 3


def test_posed_meshes_forget_where_the_body_stands_and_looks(
    smooth_recording: Recording, smooth_frames: TrainingFrames
) -> None:
    clip = smooth_recording.clips[0]
    root = smooth_recording.rig.skeleton.root
    turn = rotation.from_axis_angle(np.array([0.0, 1, 0]), 1.1)
    rotations = clip.rotations.copy()
    rotations[:, root] = rotation.multiply(turn, rotations[:, root])
    places = clip.translations.copy()
    places[:, root] = rotation.rotate(turn, places[:, root]) + np.array([3.0, 0, -2])
    moved = Clip("moved", clip.rate, rotations, places)
    one, other = (
        motion_of(c, np.arange(6), rig=smooth_recording.rig, student=smooth_frames.student) for c in (clip, moved)
    )
    torch.testing.assert_close(one.posed, other.posed, rtol=0, atol=1e-4)
    assert float((one.posed[5] - one.posed[0]).abs().max()) > 0.01


def test_posed_meshes_keep_where_the_body_looks_where_descriptors_do(smooth_recording: Recording) -> None:
    rig, clip = smooth_recording.rig, smooth_recording.clips[0]
    root, turn = rig.skeleton.root, rotation.from_axis_angle(np.array([0.0, 1, 0]), 1.1)
    rotations = clip.rotations.copy()
    rotations[:, root] = rotation.multiply(turn, rotations[:, root])
    turned = Clip("turned", clip.rate, rotations, clip.translations)
    one, other = (pose_about_root(rig, rig.mesh.vertices, c, 3, remove_heading=False) for c in (clip, turned))
    np.testing.assert_allclose(other, rotation.rotate(np.broadcast_to(turn, (len(one), 4)), one), atol=1e-9)


def test_a_variance_is_that_of_a_texel(smooth_frames: TrainingFrames) -> None:
    size = smooth_frames.sizes.settings.texels
    mean, variance = band_statistics(smooth_frames.bands, frames=len(smooth_frames), texels=size)
    rows = torch.arange(len(smooth_frames))
    energy = torch.zeros(23)
    for band, middle in zip(smooth_frames.bands(slice(0, 23), rows), mean, strict=True):
        away = (band - middle).square()
        energy += away.movedim(1 if band.dim() == 4 else 2, 0).flatten(1).sum(1)
    torch.testing.assert_close(variance, energy / (len(rows) * size**2), rtol=1e-4, atol=0)


def test_errors_of_channels_are_weighed_by_how_much_they_vary(
    smooth_recording: Recording, smooth_frames: TrainingFrames
) -> None:
    texels = smooth_frames.sizes.settings.texels
    _, variance = band_statistics(smooth_frames.bands, frames=len(smooth_frames), texels=texels)
    size = np.ptp(smooth_recording.rig.mesh.vertices, axis=0).max() / PERSON
    weights = [channel_weights(variance[part], part, size=size) for part in (GEOMETRY, APPEARANCE)]
    torch.testing.assert_close(smooth_frames.weights, torch.cat(weights))


def test_systems_see_the_teachers_mesh(smooth_recording: Recording, smooth_frames: TrainingFrames) -> None:
    samples = prepare(smooth_recording, SETTINGS)[1]
    meshes = samples.meshes(torch.arange(len(samples)))
    missed = (smooth_frames.motion.canonical - meshes).square().sum()
    assert missed < 0.01 * (meshes - meshes.mean(dim=0)).square().sum()


def test_held_out_frames_are_predicted(smooth_recording: Recording, smooth_frames: TrainingFrames) -> None:
    (clip,) = (clip for clip in smooth_recording.clips if clip.held_out)
    motion = motion_of(clip, clip.recorded, rig=smooth_recording.rig, student=smooth_frames.student)
    textures = trained("ours", smooth_frames, Budget(steps=STEPS)).textures(motion)
    truth = [frame.texture for frame in smooth_recording.whole_frames(held_out=True)]
    kept = textures[::5][: len(truth)].numpy()
    assert textures.shape == (HELD_OUT, len(smooth_recording.rig.texels.texels), 23)
    assert np.abs(kept - truth).mean() < np.abs(smooth_frames.mean_texture.numpy() - truth).mean()
