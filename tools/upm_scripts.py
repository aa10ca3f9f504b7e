"""Rules for the C# of UPM packages, as faults: assembly definitions, symbols, and types against file names."""

import json
import re
from collections.abc import Iterator, Sequence
from pathlib import PurePosixPath

from upm_package import Assembly, Package

TEST_FRAMEWORK = "com.unity.test-framework"
TEST_LIBRARY = "nunit.framework.dll"
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
SYMBOL = re.compile(r"[A-Za-z_]\w*")
SEMVER = r"\d+(\.\d+){0,2}(-[\w.]+)?"
EXPRESSION = re.compile(rf"({SEMVER})?|[\[(]{SEMVER}[\])]|[\[(]({SEMVER})?,({SEMVER})?[\])]")

# What Unity 6 may define; a symbol that nobody defines hides code for ever.
SYMBOLS = {
    "DEBUG", "DEVELOPMENT_BUILD", "ENABLE_IL2CPP", "ENABLE_INPUT_SYSTEM", "ENABLE_LEGACY_INPUT_MANAGER", "ENABLE_MONO",
    "ENABLE_PROFILER", "ENABLE_VR", "TRACE", "UNITY_64", "UNITY_ANDROID", "UNITY_ASSERTIONS", "UNITY_EDITOR",
    "UNITY_EDITOR_64", "UNITY_EDITOR_LINUX", "UNITY_EDITOR_OSX", "UNITY_EDITOR_WIN", "UNITY_INCLUDE_TESTS",
    "UNITY_SERVER", "UNITY_STANDALONE", "UNITY_STANDALONE_LINUX", "UNITY_STANDALONE_OSX", "UNITY_STANDALONE_WIN",
    "UNITY_WEBGL",
}  # fmt: skip
VERSION_SYMBOL = re.compile(r"UNITY_\d+_\d+_OR_NEWER")
CONDITION = re.compile(r"^\s*#\s*(?:el)?if\s+(.*)$", re.MULTILINE)
DEFINED = re.compile(r"^\s*#\s*define\s+(\w+)", re.MULTILINE)

# The engine's own parts that a project may have switched off, by the words that need them.
MODULES = {
    r"Animator|AnimationClip|HumanBodyBones": "com.unity.modules.animation",
    r"AndroidJava\w+": "com.unity.modules.androidjni",
    r"AudioSource|AudioClip": "com.unity.modules.audio",
    r"AssetBundle": "com.unity.modules.assetbundle",
    r"LoadImage|EncodeToPNG|ImageConversion": "com.unity.modules.imageconversion",
    r"JsonUtility": "com.unity.modules.jsonserialize",
    r"Collider|Rigidbody|Physics": "com.unity.modules.physics",
    r"ScreenCapture": "com.unity.modules.screencapture",
    r"UnityWebRequest|DownloadHandler\w*": "com.unity.modules.unitywebrequest",
    r"XRSettings|XRStats|XRDevice": "com.unity.modules.vr",
    r"InputDevices|XRNode|XRDisplaySubsystem|XRInputSubsystem": "com.unity.modules.xr",
}

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|@"(?:[^"]|"")*"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
TOKEN = re.compile(
    r"[{}]|\bnamespace\s+(?P<namespace>[\w.]+)|\b(?:class|struct|interface|enum)\s+(?P<type>\w+)"
    r"|\bdelegate\s+[\w.<>\[\], ]+?\s(?P<delegate>\w+)\s*[<(]"
)
OURS = "Mua"


def definition_faults(packages: Sequence[Package]) -> Iterator[str]:
    """Assembly definitions are well-formed, have names of their own and refer to assemblies that exist."""
    known: dict[str, str] = {}
    for package in packages:
        yield from _unreadable(package)
        for assembly in package.assemblies:
            where = package.where(assembly.path)
            other = known.setdefault(assembly.name, where)
            if other != where:
                yield f'{where}: name: "{assembly.name}" is also that of {other}'
    every = [assembly for package in packages for assembly in package.assemblies]
    for package in packages:
        folders = [assembly.path.parent for assembly in package.assemblies]
        for assembly in package.assemblies:
            yield from _shape(package, assembly)
            yield from _references(package, assembly, set(known))
            if assembly.name in reached(assembly, every):
                yield f"{package.where(assembly.path)}: references: lead back to {assembly.name}"
            yield from _symbols(package, assembly)
            if folders.count(assembly.path.parent) > 1:
                yield f"{package.where(assembly.path)}: not the only assembly definition of its folder"


def reached(assembly: Assembly, every: Sequence[Assembly]) -> set[str]:
    """Names of the assemblies that one refers to, and that those refer to."""
    by_name = {each.name: each for each in every}
    found: set[str] = set()
    waiting = [assembly]
    while waiting:
        names = {str(name) for name in waiting.pop().items("references")} - found
        found |= names
        waiting += [by_name[name] for name in names if name in by_name]
    return found


def _unreadable(package: Package) -> Iterator[str]:
    read = {assembly.path for assembly in package.assemblies}
    for path in package.files(".asmdef"):
        if path not in read:
            yield f"{package.where(path)}: expected a JSON object"


def _shape(package: Package, assembly: Assembly) -> Iterator[str]:
    where, definition = package.where(assembly.path), assembly.definition
    if assembly.name != assembly.path.stem:
        yield f'{where}: name: "{assembly.name}", expected the name of the file'
    if not _is_ours(str(definition.get("rootNamespace", ""))):
        yield f'{where}: rootNamespace: "{definition.get("rootNamespace", "")}", expected {OURS} or below it'
    yield from (f"{where}: {key}: a field that Unity does not know" for key in definition if key not in FIELDS)
    for key in ("includePlatforms", "excludePlatforms"):
        for platform in assembly.items(key):
            if platform not in PLATFORMS:
                yield f"{where}: {key}: {json.dumps(platform)}, expected one of {', '.join(sorted(PLATFORMS))}"
    for name in assembly.items("precompiledReferences"):
        if name != TEST_LIBRARY or not definition.get("overrideReferences"):
            yield f"{where}: precompiledReferences: {json.dumps(name)}, expected {TEST_LIBRARY}, and overrideReferences"
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
            yield f"{field} is no assembly of these packages, nor one of Unity's that tools/upm_scripts.py lists"
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


def source_faults(package: Package) -> Iterator[str]:
    """Each .cs file holds one type of its own name in our namespace, in an assembly, under symbols that can be."""
    for path in package.files(".cs"):
        where = package.where(path)
        assembly = _assembly_of(package, path)
        text = NO_CODE.sub(lambda match: '""' if match[0][0] not in "/" else " ", package.text(path))
        if assembly is None:
            yield f"{where}: in no assembly, expected an .asmdef in its folder or above"
        known = SYMBOLS | set(DEFINED.findall(text)) | (assembly.symbols if assembly else set())
        for condition in CONDITION.findall(text):
            for symbol in sorted(set(SYMBOL.findall(condition)) - known - {"true", "false"}):
                if not VERSION_SYMBOL.fullmatch(symbol):
                    yield f"{where}: #if {symbol}: nothing defines it, expected a symbol of Unity or of versionDefines"
        for words, module in MODULES.items():
            found = re.search(rf"\b({words})\b", text)
            if found and module not in package.manifest.get("dependencies", {}):
                yield f"{where}: {found[0]} of {module}, which is not in dependencies"
        yield from _types(where, path.stem, text)


def _types(where: str, stem: str, text: str) -> Iterator[str]:
    found = list(outermost(text))
    if not found and stem != "AssemblyInfo":
        yield f"{where}: no type, expected {stem}"
    for namespace, name in found:
        if name != stem:
            yield f"{where}: type {name}, expected only {stem}, the name of the file"
        if not _is_ours(namespace):
            yield f'{where}: type {name}: namespace "{namespace}", expected {OURS} or below it'


def outermost(text: str) -> Iterator[tuple[str, str]]:
    """Namespace and name of the types of a source that lie in no other; comments and strings are already gone."""
    namespaces: list[tuple[int, str]] = []  # depth of the braces around each, and its name
    depth, pending = 0, ""
    for token in TOKEN.finditer(text):
        if token["namespace"]:
            pending = token["namespace"]
        elif token[0] == "{":
            if pending:
                namespaces.append((depth, pending))
                pending = ""
            depth += 1
        elif token[0] == "}":
            depth -= 1
            if namespaces and namespaces[-1][0] == depth:
                namespaces.pop()
        elif depth == len(namespaces):
            yield ".".join(name for _, name in namespaces), token["type"] or token["delegate"]


def _assembly_of(package: Package, path: PurePosixPath) -> Assembly | None:
    by_folder = {assembly.path.parent: assembly for assembly in package.assemblies}
    return next((by_folder[folder] for folder in path.parents if folder in by_folder), None)


def _is_ours(namespace: str) -> bool:
    return namespace == OURS or namespace.startswith(f"{OURS}.")
