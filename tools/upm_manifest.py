"""Rules for package.json, as faults: what Unity's package manager asks of each field."""

import json
import re
from collections.abc import Callable, Iterator
from typing import Any

from upm_package import Package

NAME = re.compile(r"[a-z][a-z0-9_-]*(\.[a-z0-9_-]+){2,}")
VERSION = re.compile(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?")
LONGEST_NAME = 214
GONE = {"com.unity.modules.vr": "6000.5"}  # Unity's own packages that newer editors lack
PAGES = ("README.md",)
PAGES_OF_SCRIPTS = ("CHANGELOG.md", "LICENSE.md")  # of a package that people install on its own


def _is_text(value: Any) -> bool:
    return isinstance(value, str) and value.strip() != ""


def _matches(pattern: str) -> Callable[[Any], bool]:
    return lambda value: isinstance(value, str) and re.fullmatch(pattern, value) is not None


def _is_author(value: Any) -> bool:
    return _is_text(value) or (isinstance(value, dict) and _is_text(value.get("name")))


def _are_texts(value: Any) -> bool:
    return isinstance(value, list) and all(map(_is_text, value))


# Field: what holds for its value, and how a fault names it. Fields that these packages do not have are none.
FIELDS: dict[str, tuple[Callable[[Any], bool], str]] = {
    "name": (
        lambda value: _matches(NAME.pattern)(value) and len(value) <= LONGEST_NAME,
        "a name like com.owner.package",
    ),
    "version": (_matches(VERSION.pattern), "a version like 1.2.3"),
    "displayName": (_is_text, "a text"),
    "description": (_is_text, "a text"),
    "unity": (_matches(r"\d{4}\.\d+"), "a version of the editor like 6000.0"),
    "dependencies": (lambda value: isinstance(value, dict), "an object of names and versions"),
    "samples": (lambda value: isinstance(value, list), "a list of samples"),
    "keywords": (_are_texts, "a list of words"),
    "author": (_is_author, "a name, or an object with one"),
    "license": (_matches(r"[A-Za-z0-9.+-]+"), "an SPDX identifier"),
}
REQUIRED = ("name", "version", "displayName", "description", "unity", "license")


def faults(package: Package, siblings: dict[str, str]) -> Iterator[str]:
    """Faults of a manifest; `siblings` are names and versions of all the packages of this repository."""
    where = f"{package.name}/package.json"
    try:
        read = json.loads((package.root / "package.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        yield f"{where}: not there, expected the package's manifest"
        return
    except ValueError as error:
        yield f"{where}: {error}, expected JSON"
        return
    if not isinstance(read, dict):
        yield f"{where}: {json.dumps(read)}, expected an object"
        return
    yield from (f"{where}: {key}: not there, expected {FIELDS[key][1]}" for key in REQUIRED if key not in read)
    for key, value in read.items():
        if key not in FIELDS:
            yield f"{where}: {key}: not a field of FIELDS in tools/upm_manifest.py"
        elif not FIELDS[key][0](value):
            yield f"{where}: {key}: {json.dumps(value)}, expected {FIELDS[key][1]}"
    yield from _dependencies(where, read, siblings)
    yield from _samples(where, read, package)


def _dependencies(where: str, manifest: dict[str, Any], siblings: dict[str, str]) -> Iterator[str]:
    dependencies = manifest.get("dependencies")
    for name, version in dependencies.items() if isinstance(dependencies, dict) else ():
        field = f"{where}: dependencies.{name}"
        if not NAME.fullmatch(name):
            yield f"{field}: not the name of a package"
        if not isinstance(version, str) or not VERSION.fullmatch(version):
            yield f"{field}: {json.dumps(version)}, expected an exact version, no range and no address"
        elif name in siblings and version != siblings[name]:
            yield f'{field}: "{version}", expected "{siblings[name]}", the version of that package here'
        elif name in GONE:
            yield f"{field}: gone from Unity {GONE[name]} on, where the package could not be installed"
        elif name not in siblings and not name.startswith("com.unity."):
            yield f'{field}: "{version}", expected only packages of Unity\'s own registry and of this repository'


def _samples(where: str, manifest: dict[str, Any], package: Package) -> Iterator[str]:
    listed = set()
    samples = manifest.get("samples")
    for index, sample in enumerate(samples if isinstance(samples, list) else ()):
        field = f"{where}: samples[{index}]"
        if not isinstance(sample, dict):
            yield f"{field}: {json.dumps(sample)}, expected displayName, description and path"
            continue
        for key in ("displayName", "description", "path"):
            if not _is_text(sample.get(key)):
                yield f"{field}.{key}: {json.dumps(sample.get(key))}, expected a text"
        path = str(sample.get("path"))
        listed.add(path)
        if not re.fullmatch(r"Samples~/[^/.~]+", path):
            yield f"{field}.path: {json.dumps(path)}, expected a folder directly below Samples~"
        elif not any(entry.is_relative_to(path) and not package.is_folder(entry) for entry in package.entries):
            yield f"{field}.path: {json.dumps(path)}, expected a folder with files in it"
    for entry in package.entries:
        if entry.parent.as_posix() == "Samples~" and package.is_folder(entry) and entry.as_posix() not in listed:
            yield f"{package.where(entry)}: a sample that package.json does not list"


def page_faults(package: Package) -> Iterator[str]:
    """The pages that the package manager shows are there, and the changelog knows the version."""
    for name in (*PAGES, *(PAGES_OF_SCRIPTS if package.assemblies else ())):
        if not (package.root / name).is_file():
            yield f"{package.name}/{name}: not there, expected a page beside package.json"
    changelog, version = package.root / "CHANGELOG.md", package.manifest.get("version")
    if changelog.is_file() and f"## {version}" not in changelog.read_text(encoding="utf-8"):
        yield f'{package.name}/CHANGELOG.md: no heading "## {version}", expected one for the version of package.json'
