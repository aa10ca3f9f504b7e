"""Rules for the assembly definitions of UPM packages, as faults."""

import json
import re
from collections.abc import Iterator, Sequence

from upm_package import Assembly, Package
from upm_scripts import OURS, SYMBOL, SYMBOLS, VERSION_SYMBOL, is_ours

TEST_FRAMEWORK = "com.unity.test-framework"
# Assemblies of Unity's packages that ours may refer to, and the package of each.
UNITY = {
    "UnityEngine.TestRunner": TEST_FRAMEWORK,
    "UnityEditor.TestRunner": TEST_FRAMEWORK,
    "Unity.RenderPipelines.Core.Runtime": "com.unity.render-pipelines.core",
    "Unity.RenderPipelines.Core.Editor": "com.unity.render-pipelines.core",
    "Unity.RenderPipelines.Universal.Runtime": "com.unity.render-pipelines.universal",
    "Unity.RenderPipelines.Universal.Editor": "com.unity.render-pipelines.universal",
    "Unity.InputSystem": "com.unity.inputsystem",
    "Unity.TextMeshPro": "com.unity.ugui",
    "Unity.Timeline": "com.unity.timeline",
    "UnityEngine.UI": "com.unity.ugui",
    "Unity.XR.CoreUtils": "com.unity.xr.core-utils",
    "Unity.XR.MetaOpenXR": "com.unity.xr.meta-openxr",
    "Unity.XR.Management": "com.unity.xr.management",
    "Unity.XR.Management.Editor": "com.unity.xr.management",
    "Unity.XR.OpenXR": "com.unity.xr.openxr",
    "Unity.XR.OpenXR.Editor": "com.unity.xr.openxr",
    "Unity.XR.OpenXR.Features.MetaQuestSupport": "com.unity.xr.openxr",
    "Unity.XR.OpenXR.Features.MetaQuestSupport.Editor": "com.unity.xr.openxr",
}
BRINGS = {"com.unity.render-pipelines.core": "com.unity.render-pipelines.universal"}  # the second brings the first
FIELDS = {
    "name", "rootNamespace", "references", "includePlatforms", "excludePlatforms", "allowUnsafeCode",
    "overrideReferences", "precompiledReferences", "autoReferenced", "defineConstraints", "versionDefines",
    "noEngineReferences", "optionalUnityReferences",
}  # fmt: skip
PLATFORMS = {"Editor", "Android", "WindowsStandalone64", "WindowsStandalone32", "LinuxStandalone64", "macOSStandalone"}
SEMVER = r"\d+(\.\d+){0,2}(-[\w.]+)?"
EXPRESSION = re.compile(rf"({SEMVER})?|[\[(]{SEMVER}[\])]|[\[(]({SEMVER})?,({SEMVER})?[\])]")


def faults(packages: Sequence[Package]) -> Iterator[str]:
    """Assembly definitions are well-formed, have names of their own and refer to assemblies that exist."""
    known: dict[str, str] = {}
    for package in packages:
        yield from _unreadable(package)
        for assembly in package.assemblies:
            where = package.where(assembly.path)
            other = known.setdefault(assembly.name, where)
            if other != where:
                yield f'{where}: name: "{assembly.name}" is also that of {other}'
    for package in packages:
        for assembly in package.assemblies:
            yield from _shape(package, assembly)
            yield from _references(package, assembly, set(known))
            yield from _symbols(package, assembly)


def _unreadable(package: Package) -> Iterator[str]:
    read = {assembly.path for assembly in package.assemblies}
    for path in package.files(".asmdef"):
        if path not in read:
            yield f"{package.where(path)}: expected a JSON object"


def _shape(package: Package, assembly: Assembly) -> Iterator[str]:
    where, definition = package.where(assembly.path), assembly.definition
    if assembly.name != assembly.path.stem:
        yield f'{where}: name: "{assembly.name}", expected the name of the file'
    if not is_ours(str(definition.get("rootNamespace", ""))):
        yield f'{where}: rootNamespace: "{definition.get("rootNamespace", "")}", expected {OURS} or below it'
    yield from (f"{where}: {key}: a field that Unity does not know" for key in definition if key not in FIELDS)
    for key in ("includePlatforms", "excludePlatforms"):
        for platform in assembly.items(key):
            if platform not in PLATFORMS:
                yield f"{where}: {key}: {json.dumps(platform)}, expected one of {', '.join(sorted(PLATFORMS))}"
    in_editor = "Editor" in assembly.path.parts[:-1]
    if in_editor != (assembly.items("includePlatforms") == ["Editor"]):
        expected = '["Editor"] for what lies below Editor/' if in_editor else "no editor only, outside Editor/"
        yield f"{where}: includePlatforms: {json.dumps(assembly.items('includePlatforms'))}, expected {expected}"


def _references(package: Package, assembly: Assembly, own: set[str]) -> Iterator[str]:
    where = package.where(assembly.path)
    needed = package.manifest.get("dependencies", {})
    optional = {str(rule.get("name")) for rule in assembly.items("versionDefines") if isinstance(rule, dict)}
    for name in assembly.items("references"):
        field = f"{where}: references: {json.dumps(name)}"
        owner = UNITY.get(str(name))
        if owner is None and name not in own:
            yield f"{field} is no assembly of these packages, nor one of Unity's that tools/upm_assemblies.py lists"
        elif owner == TEST_FRAMEWORK and "UNITY_INCLUDE_TESTS" not in assembly.items("defineConstraints"):
            yield f'{field}, expected "UNITY_INCLUDE_TESTS" in defineConstraints'
        elif owner not in (None, TEST_FRAMEWORK) and not {owner, BRINGS.get(str(owner))} & {*needed, *optional}:
            yield f"{field} of {owner}, which is neither in dependencies nor in versionDefines"


def _symbols(package: Package, assembly: Assembly) -> Iterator[str]:
    where = package.where(assembly.path)
    for index, rule in enumerate(assembly.items("versionDefines")):
        field = f"{where}: versionDefines[{index}]"
        if not isinstance(rule, dict) or set(rule) != {"name", "expression", "define"}:
            yield f"{field}: {json.dumps(rule)}, expected name, expression and define"
            continue
        if not re.fullmatch(r"Unity|[a-z][a-z0-9-]*(\.[a-z0-9-]+)+", str(rule["name"])):
            yield f'{field}.name: "{rule["name"]}", expected a package'
        if not EXPRESSION.fullmatch(str(rule["expression"])):
            yield f'{field}.expression: "{rule["expression"]}", expected a version or a range like [1.0,2.0)'
        if not SYMBOL.fullmatch(str(rule["define"])):
            yield f'{field}.define: "{rule["define"]}", expected a symbol'
    for constraint in assembly.items("defineConstraints"):
        unknown = set(SYMBOL.findall(str(constraint))) - SYMBOLS - assembly.symbols
        if any(not VERSION_SYMBOL.fullmatch(symbol) for symbol in unknown):
            yield f'{where}: defineConstraints: "{constraint}", expected symbols of Unity or of versionDefines'
