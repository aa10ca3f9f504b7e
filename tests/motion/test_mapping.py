"""Mapping files are read from JSON and TOML, written to start from, and refused when they are none."""

from pathlib import Path

import pytest

from mua.errors import InputError
from mua.motion.mapping import read_mapping, write_mapping
from mua.motion.match import JointPair


def test_reads_a_mapping_from_json_and_toml(tmp_path: Path) -> None:
    (tmp_path / "map.json").write_text('{"LeftArm": "Bone 1"}')
    (tmp_path / "map.toml").write_text('LeftArm = "Bone 1"\n')
    for name in ("map.json", "map.toml"):
        assert read_mapping(tmp_path / name) == {"LeftArm": "Bone 1"}


@pytest.mark.parametrize("text", ["{", "[1]", '{"LeftArm": 3}', '"LeftArm"'])
def test_rejects_a_mapping_file_that_is_no_table_of_names(tmp_path: Path, text: str) -> None:
    (tmp_path / "map.json").write_text(text)
    with pytest.raises(InputError, match=r"map\.json"):
        read_mapping(tmp_path / "map.json")


def test_rejects_an_absent_mapping_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"absent\.toml"):
        read_mapping(tmp_path / "absent.toml")


@pytest.mark.parametrize("name", ["map.json", "map.toml"])
def test_reads_back_what_it_wrote_and_leaves_out_joints_without_a_source(tmp_path: Path, name: str) -> None:
    pairs = [JointPair("mixamorig:Hips", "root", "hips"), JointPair('Arm "L".001', "Wörm", "")]
    write_mapping(tmp_path / name, pairs, unmatched=["Tail"])
    assert "Tail" in (tmp_path / name).read_text(encoding="utf-8")
    assert read_mapping(tmp_path / name) == {"mixamorig:Hips": "root", 'Arm "L".001': "Wörm"}
