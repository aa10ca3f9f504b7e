"""The importer's portrait against one drawn with numpy: every sample against every triangle."""

import base64
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, CSharp
from scipy.ndimage import map_coordinates
from synthetic_avatar import SIZE, synthetic_avatar
from test_compiles import Compiler, assemblies

from mua.arrays import Array
from mua.asset import write
from mua.asset.avatar import Avatar

SAMPLES, MARGIN, AMBIENT = 2, 0.06, 0.65  # of a pixel along each side; of the picture; of the light
TURN = np.radians(25)  # of the eye, from the front to the character's left
LIGHT = np.array([-0.3, 0.6, 0.74])
CONSTANT_TERM = 0.5 / np.sqrt(np.pi)  # of the spherical harmonics


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    """Named as the assembly that may see the package's internals."""
    compiler, known = Compiler(csharp, "editor", packages=False), assemblies()
    package = [name for name in known["Mua.Avatar.Editor"].references if name in known]
    references = [compiler.built(name) for name in ("UnityEngine", "UnityEditor", *package, "Mua.Avatar.Editor")]
    return csharp.build([PROGRAMS / "PortraitProgram.cs"], name="Mua.Avatar.Editor.Tests", references=references)


def colourful(*, mirrored: bool = False, fewer: int = 0) -> Avatar:
    """A tube, wider than deep and off centre, of texels of many colours; those of the first `fewer` faces are gone."""
    avatar, rng = synthetic_avatar(), np.random.default_rng(7)
    texels = avatar.rig.texels
    kept = texels.triangles >= fewer
    texels = replace(
        texels,
        texels=texels.texels[kept],
        triangles=texels.triangles[kept],
        barycentrics=texels.barycentrics[kept],
    )
    static = rng.normal(scale=0.5, size=(12, kept.sum())).astype(np.float32)
    low = rng.normal(scale=8, size=avatar.appearance.ll_mean.shape).astype(np.float32)
    faces = avatar.rig.mesh.faces[:, ::-1] if mirrored else avatar.rig.mesh.faces
    uv_faces = avatar.rig.mesh.uv_faces[:, ::-1] if mirrored else avatar.rig.mesh.uv_faces
    mean = avatar.coarse.mean * np.array([2, 0.5, 1], np.float32) + np.array([0.3, -0.2, 0.1], np.float32)
    return replace(
        avatar,
        rig=replace(avatar.rig, mesh=replace(avatar.rig.mesh, faces=faces, uv_faces=uv_faces), texels=texels),
        coarse=replace(avatar.coarse, mean=mean),
        geometry=replace(avatar.geometry, static=avatar.geometry.static[:, kept]),
        appearance=replace(avatar.appearance, static=static, ll_mean=low),
    )


def colours(avatar: Avatar) -> tuple[Array, Array]:
    """Average colour [N, 3] of the texels and [F, 3] of the faces, grey where a face has none."""
    texels, low = avatar.rig.texels, avatar.appearance.ll_mean[:3].astype(np.float64)
    step = SIZE // low.shape[1]
    at = np.array(np.divmod(texels.texels, SIZE)) / step
    gain = (avatar.wavelet.rec_lo.sum() / 2) ** (2 * avatar.wavelet.levels)
    smooth = np.stack([map_coordinates(channel, at, order=1, mode="grid-wrap") for channel in low], axis=1)
    of_texels = 0.5 + CONSTANT_TERM * (gain * smooth + avatar.appearance.static[:3].T)
    of_faces = np.full((len(avatar.rig.mesh.faces), 3), 0.5)
    for face in np.unique(texels.triangles):
        of_faces[face] = of_texels[texels.triangles == face].mean(axis=0)
    return of_texels, of_faces


def drawn(avatar: Avatar, size: int) -> Array:
    """[size, size, 4] as Portrait.Draw gives it, before it is rounded."""
    mesh, side = avatar.rig.mesh, SAMPLES * size
    eye = np.array([[np.cos(TURN), 0, -np.sin(TURN)], [0, 1, 0], [np.sin(TURN), 0, np.cos(TURN)]])
    points = avatar.coarse.mean.astype(np.float64) @ eye.T
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    scale = side * (1 - 2 * MARGIN) / (high - low).max()
    points = scale * (points - [*(low + high) / 2, 0]) + [side / 2, side / 2, 0]
    rows, columns = np.divmod(np.arange(side * side), side)
    centres = np.stack([columns + 0.5, rows + 0.5, np.ones(side * side)])
    of_texels, of_faces = colours(avatar)
    texel_at = np.full(SIZE * SIZE, -1)
    texel_at[avatar.rig.texels.texels] = np.arange(len(of_texels))
    picture, nearest = np.zeros((side * side, 4)), np.full(side * side, -np.inf)
    for face, (corners, uv) in enumerate(
        zip(points[mesh.faces], mesh.uv.astype(np.float32)[mesh.uv_faces], strict=True)
    ):
        shares = np.linalg.solve(np.vstack([corners[:, :2].T, np.ones(3)]), centres)  # [3, samples]
        depth = corners[:, 2] @ shares
        hit = (shares >= 0).all(axis=0) & (depth > nearest)
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        shade = AMBIENT + (1 - AMBIENT) * max(0, LIGHT @ normal / np.linalg.norm(normal))
        column, row = np.floor(uv.T @ shares[:, hit] * SIZE).astype(int)
        texel = texel_at[row * SIZE + column]
        picture[hit, :3] = shade * np.where(texel[:, None] < 0, of_faces[face], of_texels[texel])
        picture[hit, 3], nearest[hit] = 1, depth[hit]
    sums = picture.reshape(size, SAMPLES, size, SAMPLES, 4).sum(axis=(1, 3))
    sums[..., :3] /= np.maximum(sums[..., 3:], 1)
    sums[..., 3] /= SAMPLES**2
    return np.asarray(255 * np.clip(sums, 0, 1))


@pytest.mark.parametrize(
    "avatar",
    [colourful(), colourful(mirrored=True), colourful(fewer=6), synthetic_avatar(wavelet="haar")],
    ids=["texels", "faces turned inside out", "faces without texels", "haar"],
)
@pytest.mark.parametrize("size", [24, 33])
def test_a_portrait_shows_what_numpy_draws(
    csharp: CSharp, program: Path, tmp_path: Path, avatar: Avatar, size: int
) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, avatar, storage="f32")
    pixels = np.frombuffer(base64.b64decode(csharp.run(program, path, size)), np.uint8).reshape(size, size, 4)
    np.testing.assert_allclose(pixels, drawn(avatar, size), atol=0.5 + 1e-4)  # rounded to bytes


def test_the_character_fills_the_picture_up_to_its_margin(csharp: CSharp, program: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.muaavatar"
    write(path, synthetic_avatar(), storage="f32")
    shown = np.frombuffer(base64.b64decode(csharp.run(program, path, 100)), np.uint8).reshape(100, 100, 4)[..., 3] > 0
    rows = np.flatnonzero(shown.any(axis=1))
    assert (rows[0], rows[-1]) == (6, 93)
