"""Students of several sizes beside their teacher: what each costs, and which is nearer."""

from pathlib import Path

import pytest
from train_ranks import main
from trainings import be_small

from mua.recording import Recording

FEW, MANY = "1,1,1/1,1,1/1/8", "4,3,2/4,3,2/1/8"


def test_more_blendshapes_cost_more_and_show_more(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    be_small(monkeypatch)
    recording = tmp_path / "recording"
    recording.symlink_to(smooth_recording.directory)
    main([str(recording), "--preset", "small", "--closed-form", "--sizes", FEW, MANY])
    main([str(recording), "--preset", "small", "--sizes", MANY])  # with networks
    printed = capsys.readouterr()
    rows = [[cell.strip() for cell in line.split("|")[2:-1]] for line in printed.out.splitlines()]
    heading, _, few, many, _, _, trained = rows
    assert heading == ["geometry", "appearance", "hidden", "GFLOPs", "M parameters", "PSNR"]
    assert few[:3] == ["1 1 1", "1 1 1", "8"]
    assert float(few[3]) < float(many[3]) == float(trained[3])
    assert float(few[4]) < float(many[4]) == float(trained[4])
    psnr = [[float(kind) for kind in row[5].split(" / ")] for row in (few, many)]
    assert all(a < b for a, b in zip(*psnr, strict=True))
    assert "appearance fine-tuning: 20 of 20" in printed.err
