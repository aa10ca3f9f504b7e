"""Every rule for package.json and the pages beside it finds its fault."""

from pathlib import Path
from typing import Any

import pytest
from upm_files import MANIFEST, Break, edited, faults_after, put

MANIFESTS: list[tuple[dict[str, Any], str]] = [
    ({"name": "Mua Test"}, 'name: "Mua Test", expected a name like com.owner.package'),
    ({"version": "1.0"}, 'version: "1.0", expected a version like 1.2.3'),
    ({"version": None}, "version: not there, expected a version like 1.2.3"),
    ({"displayName": " "}, 'displayName: " ", expected a text'),
    ({"description": 7}, "description: 7, expected a text"),
    ({"unity": "6000.0.20f1"}, 'unity: "6000.0.20f1", expected a version of the editor like 6000.0'),
    ({"license": "see LICENSE"}, 'license: "see LICENSE", expected an SPDX identifier'),
    ({"author": {"mail": "x"}}, 'author: {"mail": "x"}, expected a name, or an object with one'),
    ({"keywords": "avatar"}, 'keywords: "avatar", expected a list of words'),
    ({"dependecies": {}}, "dependecies: not a field of FIELDS in tools/upm_manifest.py"),
    ({"dependencies": []}, "dependencies: [], expected an object of names and versions"),
    ({"samples": {}}, "samples: {}, expected a list of samples"),
    (
        {"dependencies": {"com.mua.other": "https://host/other.git"}},
        'dependencies.com.mua.other: "https://host/other.git", expected an exact version, no range and no address',
    ),
    (
        {"dependencies": {"com.mua.other": "0.1.0"}},
        'dependencies.com.mua.other: "0.1.0", expected "0.2.0", the version of that package here',
    ),
    (
        {"dependencies": {**MANIFEST["dependencies"], "org.else.where": "1.0.0"}},  # type: ignore[dict-item]
        'dependencies.org.else.where: "1.0.0", expected only packages of Unity\'s own registry and of this repository',
    ),
    (
        {"dependencies": {**MANIFEST["dependencies"], "Unity": "1.0.0"}},  # type: ignore[dict-item]
        "dependencies.Unity: not the name of a package",
    ),
    (
        {"dependencies": {**MANIFEST["dependencies"], "com.unity.modules.vr": "1.0.0"}},  # type: ignore[dict-item]
        "dependencies.com.unity.modules.vr: gone from Unity 6000.5 on, where the package could not be installed",
    ),
    ({"samples": ["Viewer"]}, 'samples[0]: "Viewer", expected displayName, description and path'),
    (
        {"samples": [{"displayName": "Viewer", "path": "Samples~/Viewer"}]},
        "samples[0].description: null, expected a text",
    ),
    (
        {"samples": [{"displayName": "Viewer", "description": "x", "path": "Samples/Viewer"}]},
        'samples[0].path: "Samples/Viewer", expected a folder directly below Samples~',
    ),
    (
        {"samples": [{"displayName": "Viewer", "description": "x", "path": "Samples~/Gone"}]},
        'samples[0].path: "Samples~/Gone", expected a folder with files in it',
    ),
]


@pytest.mark.parametrize(
    ("changes", "fault"), MANIFESTS, ids=lambda value: value[:30] if isinstance(value, str) else ""
)
def test_finds_a_wrong_manifest(packages: list[Path], changes: dict[str, Any], fault: str) -> None:
    found = faults_after(packages, lambda root: edited(root / "package.json", **changes))
    assert any(line.endswith(f"/package.json: {fault}") for line in found), found


@pytest.mark.parametrize(
    ("text", "fault"),
    [(None, "not there, expected the package's manifest"), ("[]", "[], expected an object"), ("{", "expected JSON")],
)
def test_finds_a_manifest_that_cannot_be_read(packages: list[Path], text: str | None, fault: str) -> None:
    path = packages[0] / "package.json"
    found = faults_after(packages, lambda _: path.unlink() if text is None else path.write_text(text))
    assert any(line.startswith("test/package.json: ") and line.endswith(fault) for line in found)


def test_finds_samples_that_are_not_listed(packages: list[Path]) -> None:
    found = faults_after(packages, lambda root: edited(root / "package.json", samples=None))
    assert found == ["com.mua.test/Samples~/Viewer: a sample that package.json does not list"]


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("README.md", None, "not there, expected a page beside package.json"),
        ("LICENSE.md", None, "not there, expected a page beside package.json"),
        ("CHANGELOG.md", "## 0.0.9\n", 'no heading "## 0.1.0", expected one for the version of package.json'),
    ],
)
def test_finds_a_wrong_page(packages: list[Path], name: str, text: str | None, fault: str) -> None:
    change: Break = lambda root: (root / name).unlink() if text is None else put(root / name, text)  # noqa: E731
    assert faults_after(packages, change, metas=True) == [f"com.mua.test/{name}: {fault}"]
