"""Work of a frame, counted from its dispatches and by drawing."""

import json
from pathlib import Path

import numpy as np
import pytest
from commands import Commands
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.asset import write
from mua.asset.count import flops, synthesis
from mua.avatar.camera import orbit
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import projected
from mua.bench import counts
from mua.gpu import Device
from mua.kernels.splat_project import REACH, wide_deviations
from mua.player.buffers import AvatarBuffers
from mua.player.frame import AvatarFrame
from mua.player.splats import SplatFrame

NETWORK = {
    "MlpMatmul": "coefficient MLPs",
    "MlpMatmulTransposed": "PCA mesh",
    "BlendLl": "LL blend",
    "BlendDetail": "detail blend",
}


def test_network_part_costs_what_the_asset_counts(device: Device, avatar_file: Path) -> None:
    spent, expected = counts.count(device, avatar_file).whole.kernels, flops(synthetic_avatar())
    assert {name: spent[name].flops for name in NETWORK} == {n: expected[p] for n, p in NETWORK.items()}
    branches = (synthetic_avatar().geometry, synthetic_avatar().appearance)
    detailed = [(b.channels, b.ll_mean.shape[-1], len(b.details), len(b.details)) for b in branches]
    assert spent["InverseDwt"].flops == sum(synthesis(*levels, taps=10) for levels in detailed)


def test_counts_what_a_frame_must_do(avatar_file: Path, tmp_path: Path, command: Commands) -> None:
    output = tmp_path / "counts.json"
    ran = command("bench", avatar_file, "--counts", "--json", output)
    report = json.loads(output.read_text())
    assert all(name in ran.out for name in (*report["kernels"], "peak frame", "part 2", "2.2"))
    assert report["dispatches"] == {"decode": 30, "pose": 8, "rest": 7}
    parts = [part["bytes"] for part in report["parts"]]
    halves = (sum(parts[:2]), sum(parts[2:]))
    assert report["bytes"]["peak_frame"] == report["bytes"]["pose"] + max(halves)
    assert report["bytes"]["decode"] == sum(parts)
    assert report["bytes"]["pose"] + sum(parts) == sum(kernel["bytes"] for kernel in report["kernels"].values())
    assert [part["dispatches"] for part in report["parts"]] == [7, 6, 7, 2]
    assert report["triangles"]["2.2"] == 2 * report["splats"]
    assert 0 < report["fragments"]["2.2"] < report["fragments"]["1.0"] < report["fragments"]["0.6"]
    assert [level["texels"] for level in report["levels"]] == [32, 16, 8]
    assert [level["splats"] for level in report["levels"]] == [
        len(synthetic_avatar().at_level(level).rig.texels.texels) for level in range(3)
    ]
    assert report["levels"][0]["chosen_from"] == 0
    assert report["levels"][2]["chosen_from"] == 2 * report["levels"][1]["chosen_from"] > 0
    for name in ("decode", "pose"):
        moved = [level["bytes"][name] for level in report["levels"]]
        assert moved[0] == report["bytes"][name]
        assert moved[2] < moved[1] < moved[0]
    assert all(overdraw >= 1 for overdraw in report["overdraw"].values())


def test_fragments_are_the_pixels_of_all_quads(device: Device, avatar_file: Path) -> None:
    frame = SplatFrame(device, [AvatarFrame(device, AvatarBuffers(device, avatar_file))])
    avatar, clip = frame.avatars[0].avatar.avatar, frame.avatars[0].avatar.avatar.clips[0]
    window = avatar.encoding.frames(0)
    commands = device.commands()
    frame.avatars[0].decode(commands, clip.rotations[window], clip.translations[window])
    camera = orbit(avatar.bounds, screen=(160, 200))
    frame.sort(commands, [camera])
    commands.submit()
    found = counts.fragments(device, frame.sorted, camera).sum()
    posed = decode_clip_frame(avatar, clip, frame=0, dtype=np.float64)
    seen = projected(posed, camera)
    lengths = REACH * wide_deviations(seen.ellipses[:, 4:6])
    assert found == pytest.approx(4 * lengths.prod(axis=1).sum(), rel=0.02)  # all of them inside the image


def test_a_face_counts_beside_a_decode_that_stays_as_it_is(
    avatar_file: Path, tmp_path: Path, command: Commands
) -> None:
    path, output = tmp_path / "face.muaavatar", tmp_path / "counts.json"
    write(path, with_expressions(synthetic_avatar()))
    ran = command("bench", path, "--counts", "--json", output)
    assert ran.status == 0, ran.err
    face = json.loads(output.read_text())
    assert face["face"]["bytes"] > 0
    assert f"+{face['face']['flops'] / face['operations']['decode']:.1%}" in ran.out
    command("bench", avatar_file, "--counts", "--json", output)
    plain = json.loads(output.read_text())
    assert plain["face"] is None
    assert (plain["bytes"], plain["parts"]) == (face["bytes"], face["parts"])
