"""The model of a frame on a device that is not at hand, against sums by hand."""

import importlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from commands import Commands

from mua.avatar.decode_turns import LONGEST, PARTS
from mua.avatar.frame_budget import MILLISECONDS
from mua.bench.counts import Counts, Drawn, LevelCounts, Part
from mua.bench.crowd import DISPLAYED, crowd
from mua.bench.devices import DEVICES, ModelDevice, Range, model_device
from mua.bench.frame_model import BLOCK_CORNER, BLOCK_EDGE, FIXED, Modelled, model, shaded
from mua.bench.instructions import count_instructions
from mua.bench.measure import Measured, Timing
from mua.bench.work import POSING, PROJECT_EYE, Work
from mua.errors import InputError
from mua.gpu import compile, sources

HALF = Range(0.5, 0.5, 0.5)
TWO, NINE, ONE = (Range(n, n, n) for n in (2, 9, 1))
ROUND = ModelDevice("round", 2, HALF, 0.004, HALF, HALF, 0.001, TWO, NINE, 2, ONE, (), "nothing")
INSTRUCTIONS = 84


def counts(fragments: int = 4_000) -> Counts:
    """1 MB and 1 MFLOP to decode, 0.5 MB and 3 MFLOP to pose; 1,000 splats."""
    decode = tuple(Part({"BlendLl": Work(1_000 * kilo, 1_000 * kilo)}, 6) for kilo in (100, 300, 450, 150))
    pose = Part({**dict.fromkeys(POSING, Work(0, 0)), "SplatProject": Work(500_000, 3_000_000)}, 8)
    return Counts("a", 50_000, 20_000, 1_000, decode, pose, 7, (Drawn(1.0, 2_000, fragments, 10.0),))


def leveled() -> Counts:
    """The same with a level of a quarter of the splats, chosen from 4 metres on."""
    whole = counts()
    (drawn,) = whole.drawn
    pose = Part({**whole.pose.kernels, "SplatProject": Work(125_000, 750_000)}, 8)
    coarser = replace(drawn, triangles=500, fragments=2_000)
    levels = (
        LevelCounts(64, 1_000, 0.0, whole.decode, whole.pose, drawn),
        LevelCounts(32, 250, 4.0, whole.decode, pose, coarser),
    )
    return replace(whole, levels=levels)


def only(modelled: list[Modelled], avatars: int, eyes: int) -> Modelled:
    (found,) = (each for each in modelled if (each.avatars, each.eyes) == (avatars, eyes))
    return found


def test_a_frame_takes_what_its_counts_take_at_the_devices_rates() -> None:
    one = only(model(ROUND, counts(), INSTRUCTIONS), 1, 1).likely
    assert one.decode == pytest.approx(1.0)  # 1 MB at 1 GB/s; its operations at 2 GFLOPS take half as long
    assert one.part == pytest.approx(0.6)  # the larger half
    assert one.pose == pytest.approx(1.5)  # 3 MFLOP at 2 GFLOPS
    assert one.triangles == pytest.approx(2.0)  # 2,000, twice, at 2 for each of 1,000 clocks a millisecond
    assert one.fragments == pytest.approx(shaded(counts().drawn[0]) * 100 / 1e6)  # 84 and 16 at 1 instruction a ns
    assert one.plain == pytest.approx(1.5 + 2 + one.fragments + 1)
    assert one.spread == pytest.approx(one.plain + 0.6)
    assert one.whole == pytest.approx(one.plain + 1)
    assert FIXED == 16


def test_blending_bounds_fragments_of_few_instructions() -> None:
    slow = replace(ROUND, pixels=TWO)
    assert only(model(slow, counts(), 0), 1, 1).likely.fragments == pytest.approx(2.0)  # 4,000 at 2,000 a millisecond


def test_avatars_and_eyes_add_up_but_for_decodes_which_take_turns() -> None:
    modelled = model(ROUND, counts(), INSTRUCTIONS)
    one, both, three = (only(modelled, *asked).likely for asked in ((1, 1), (1, 2), (3, 2)))
    assert both.decode == one.decode
    assert both.pose - one.pose == pytest.approx(1e3 * PROJECT_EYE * 1_000 / 2e9)
    assert (both.triangles, both.fragments) == pytest.approx((2 * one.triangles, 2 * one.fragments))
    assert (three.decode, three.part) == pytest.approx((3 * one.decode, 0.45))  # the longest part of one decode
    assert (three.pose, three.fragments) == pytest.approx((3 * both.pose, 3 * both.fragments))
    assert three.rest == one.rest


def test_avatars_that_take_turns_have_one_part_in_their_longest_frame() -> None:
    seen = crowd(ROUND, leveled(), INSTRUCTIONS, (1.0, 1.0, 1.0))
    three = only(model(ROUND, leveled(), INSTRUCTIONS), 3, 2).likely
    assert seen.together == pytest.approx(three.plain + 3 * 0.6)
    assert seen.turns.longest == pytest.approx(three.plain + 0.45)
    assert (seen.turns.parts, seen.turns.splats) == (1, 3_000)
    assert 0 < seen.turns.oldest < 1e3 * (max(LONGEST, 3 * PARTS) + 2 * PARTS) / DISPLAYED


def test_avatars_far_away_are_coarser_and_their_fragments_fewer() -> None:
    near, far = (crowd(ROUND, leveled(), INSTRUCTIONS, (away,) * 2).turns for away in (1.0, 8.0))
    assert (near.splats, far.splats) == (2_000, 500)
    assert far.longest < near.longest


def test_a_budget_leaves_out_splats_until_a_frame_is_in_time() -> None:
    seen = crowd(ROUND, leveled(), INSTRUCTIONS, (1.0,) * 2)
    assert seen.turns.longest > MILLISECONDS
    assert seen.budget.longest <= MILLISECONDS
    assert seen.budget.splats < seen.turns.splats
    quick = crowd(replace(ROUND, bandwidth=1e3, peak=10, clock=1), leveled(), INSTRUCTIONS, (1.0,) * 3)
    assert (quick.budget.splats, quick.budget.oldest) == (3_000, 0)
    assert quick.budget.parts > PARTS


def test_blocks_of_pixels_are_those_that_squares_touch() -> None:
    """Both halves of random squares or the triangle around them, laid on the grid and sampled at pixel centres."""
    rng, side, count = np.random.default_rng(0), 6.0, 400
    y, x = (grid[..., None] for grid in np.mgrid[:24, :24] + 0.5)
    angle, middle = rng.uniform(0, 2 * np.pi, count), rng.uniform(11, 13, (2, count))
    along = np.cos(angle) * (x - middle[0]) + np.sin(angle) * (y - middle[1])
    across = np.cos(angle) * (y - middle[1]) - np.sin(angle) * (x - middle[0])
    within = np.maximum(np.abs(along), np.abs(across)) <= side / 2
    around = (np.minimum(along, across) >= -side / 2) & (along + across <= side)
    for shapes in ([within & (along > across), within & (along <= across)], [around]):
        touched = sum(4 * shape.reshape(12, 2, 12, 2, count).any(axis=(1, 3)).sum() for shape in shapes)
        found = shaded(Drawn(1.0, len(shapes) * count, sum(int(shape.sum()) for shape in shapes), 1.0))
        assert found == pytest.approx(touched, rel=0.05)
    assert BLOCK_EDGE > BLOCK_CORNER


@pytest.mark.parametrize("name", DEVICES)
def test_more_work_takes_longer_and_ends_enclose_the_likely(name: str) -> None:
    few, many = (model(DEVICES[name], counts(n), INSTRUCTIONS) for n in (4_000, 8_000))
    for less, more in zip(few, many, strict=True):
        assert less.likely.plain < more.likely.plain < more.likely.spread < more.likely.whole
        assert less.ends["best"].plain < less.likely.plain < less.ends["worst"].plain
    slower = replace(DEVICES[name], bandwidth=DEVICES[name].bandwidth / 1_000)
    assert only(model(slower, counts(), INSTRUCTIONS), 1, 1).likely.decode > only(few, 1, 1).likely.decode


@pytest.mark.parametrize("device", DEVICES.values())
def test_every_device_names_its_sources(device: ModelDevice) -> None:
    assert all("https://" in source for source in device.sources)
    assert device.sources
    assert device.assumed


def test_an_unknown_device_is_refused_with_the_known_ones(command: Commands) -> None:
    sentence = "--model is 'quest9'; expected one of quest3, adreno-x2, rtx3090"
    with pytest.raises(InputError, match=sentence):
        model_device("quest9")
    assert sentence in command("bench", "--preset", "tiny", "--model", "quest9").sentence


SHADER = """
struct Varyings { float4 position : SV_Position; float2 offset : TEXCOORD0; };
float4 Frag(Varyings varyings) : SV_Target
{
    float2 moved = varyings.offset * varyings.offset;
    return float4(moved, exp2(dot(moved, moved)), 1 / moved.x);
}
"""


def test_instructions_are_counted_by_component(tmp_path: Path) -> None:
    path = tmp_path / "small.hlsl"
    path.write_text(SHADER)
    code = compile.spirv(sources.find(path), "Frag", stage="frag")
    assert count_instructions(code) == 2 + 2 + 4 + 4  # product, dot, exponential, division


def test_prints_the_model_beside_what_is_measured(
    command: Commands, monkeypatch: pytest.MonkeyPatch, avatar_file: Path, tmp_path: Path
) -> None:
    time = Timing(1.25, 1, 2)
    kernels = dict.fromkeys(("BlendLl", *POSING), time)
    here = Measured("my device", "a", 1_000, 1_000, (64, 64), 1, 1, 1e9, kernels, counts().kernels, time)
    monkeypatch.setattr(importlib.import_module("mua.bench.counts"), "count", lambda *_: leveled())
    monkeypatch.setattr(importlib.import_module("mua.bench.measure"), "measure", lambda *_, **__: here)
    monkeypatch.setenv("COLUMNS", "160")
    output = tmp_path / "model.json"
    ran = command("bench", avatar_file, "--model", "quest3", "--json", output)
    assert ran.status == 0, ran.err
    assert "Measured on my device: decode 1.2 ms, pose 6.2 ms, drawing 1.2 ms" in ran.out
    assert "modelled from counts, not measured" in ran.out
    assert "in turns, budget" in ran.out
    assert '"decode_frame"' in output.read_text()
    assert '"crowds"' in output.read_text()


@pytest.mark.parametrize(
    ("name", "sourced"),
    [
        ("quest3", {"bandwidth": "64 GB/s", "clock": "599 MHz"}),
        ("adreno-x2", {"bandwidth": "228 GB/s", "clock": "1.85 GHz", "peak": "7.6 TFLOPS"}),
        ("rtx3090", {"bandwidth": "936 GB/s", "clock": "1.695 GHz", "peak": "35.6 TFLOPS"}),
    ],
)
def test_figures_of_a_device_are_those_of_its_sources(name: str, sourced: dict[str, str]) -> None:
    sources = " ".join(DEVICES[name].sources)
    for figure, words in sourced.items():
        assert words in sources
        number, unit = words.split()
        assert getattr(DEVICES[name], figure) == pytest.approx(float(number) * (1e-3 if unit == "MHz" else 1))


def test_the_peak_of_a_slower_clock_is_as_much_lower() -> None:
    assert "3.7 TFLOPS at 719 MHz" in " ".join(DEVICES["quest3"].sources)
    assert DEVICES["quest3"].peak == pytest.approx(3.7 * 599 / 719, rel=0.01)
