"""The package's own frames of an avatar with a face, run by mono and replayed on Vulkan, against decode()."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import ROOT, CSharp
from frame_bounds import COLOR_BOUND, FRAME_ORDER, OPACITY_BOUND, POSITION_BOUND
from frame_errors import exact_colors
from packed_splats import colors_of, opacities_of, unpacked
from recorded_frames import eye_lines
from replay import replay
from synthetic_avatar import sparse_avatar, with_expressions, with_rules

from mua.asset import read, write
from mua.asset.avatar import Avatar
from mua.asset.tensors import Storage
from mua.avatar.camera import orbit
from mua.avatar.decode import decode_clip_frame
from mua.gpu import Device
from mua.kernels.splat_project import HIDDEN

PLACE = "0 0 0 0 0 0 1 1"
LEAST_SEEN = 0.75  # of the splats
MESH = FRAME_ORDER.index("MlpMatmulTransposed") + 1
FACE_ORDER = [*FRAME_ORDER[:MESH], "SumTargets", "BendTriangles", "BendVertices"]
FACE_ORDER += ["InverseDwt", "BendTexels"]
FACE_ORDER += ["LightTexels" if kernel == "UpsampleTexels" else kernel for kernel in FRAME_ORDER[MESH + 2 :]]


@pytest.mark.parametrize(("storage", "change"), [("f32", lambda avatar: avatar), ("i8", with_rules)])
def test_a_face_moves_as_the_reference_moves_it_at_every_level(
    csharp: CSharp,
    frame_program: Path,
    device: Device,
    tmp_path: Path,
    storage: Storage,
    change: Callable[[Avatar], Avatar],
) -> None:
    """The first frame and the last; in one whose weights are all 0 nothing more is dispatched."""
    made = change(with_expressions(sparse_avatar(2)))
    [clip] = made.clips
    assert clip.expressions is not None
    weights = clip.expressions.copy()
    weights[2] = 0
    file, scenario = tmp_path / "a.muaavatar", tmp_path / "scenario.txt"
    write(file, replace(made, clips=(replace(clip, expressions=weights),)), storage=storage)
    avatar = read(file)
    [clip] = avatar.clips
    shots = [(frame, level) for frame in (0, 2, len(clip) - 1) for level in range(3)]
    camera = orbit(np.array([[-1, -1, -1], [1, 2, 1]]), screen=(64, 48))
    lines = eye_lines([camera])
    for frame, level in shots:
        lines += [f"decode 0 {(frame + 0.2) / clip.rate!r} {PLACE} {level}", f"sort {frame}.{level}"]
    scenario.write_text("\n".join([*lines, ""]))
    csharp.run(frame_program, ROOT / "ComputeShaders", tmp_path / "recording", scenario, file)
    replayed, expected = replay(device, tmp_path / "recording"), []
    for frame, level in shots:
        exact = decode_clip_frame(avatar.at_level(level), clip, frame=frame, dtype=np.float64)
        splats = unpacked(replayed.kept[f"{frame}.{level} splats"])[: len(exact.centres)]
        assert np.abs(splats["centre"] - exact.centres).max() < POSITION_BOUND
        seen = replayed.kept[f"{frame}.{level} keys"].view(np.uint16)[: len(splats)] != HIDDEN
        assert seen.mean() > LEAST_SEEN
        assert np.abs(opacities_of(splats) - exact.opacities)[seen].max() < OPACITY_BOUND
        assert np.abs(colors_of(splats) - exact_colors(exact, (camera,)))[:, seen].max() < COLOR_BOUND
        expected += FRAME_ORDER if frame == 2 else FACE_ORDER
    assert replayed.kernels == expected
