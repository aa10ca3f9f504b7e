"""Rules for the C# of UPM packages, as faults: symbols, the engine's modules, and types against file names."""

import re
from collections.abc import Iterator
from pathlib import PurePosixPath

from upm_package import Assembly, Package

SYMBOL = re.compile(r"[A-Za-z_]\w*")
# Symbols that Unity 6 may define; one that nothing defines hides code for ever.
SYMBOLS = {
    "DEBUG", "DEVELOPMENT_BUILD", "ENABLE_IL2CPP", "ENABLE_INPUT_SYSTEM", "ENABLE_LEGACY_INPUT_MANAGER", "ENABLE_MONO",
    "ENABLE_PROFILER", "ENABLE_VR", "TRACE", "UNITY_64", "UNITY_ANDROID", "UNITY_ASSERTIONS", "UNITY_EDITOR",
    "UNITY_EDITOR_64", "UNITY_EDITOR_LINUX", "UNITY_EDITOR_OSX", "UNITY_EDITOR_WIN", "UNITY_INCLUDE_TESTS",
    "UNITY_SERVER", "UNITY_STANDALONE", "UNITY_STANDALONE_LINUX", "UNITY_STANDALONE_OSX", "UNITY_STANDALONE_WIN",
    "UNITY_WEBGL", "URP_COMPATIBILITY_MODE",
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
    r"GUILayout|GUIStyle|OnGUI": "com.unity.modules.imgui",
    r"JsonUtility": "com.unity.modules.jsonserialize",
    r"Collider|Rigidbody|Physics": "com.unity.modules.physics",
    r"ScreenCapture": "com.unity.modules.screencapture",
    r"UnityWebRequest|DownloadHandler\w*": "com.unity.modules.unitywebrequest",
    r"XRSettings|XRStats|XRDevice": "com.unity.modules.vr",  # gone from 6000.5 on
    r"InputDevices|XRNode|XRDisplaySubsystem|XRInputSubsystem": "com.unity.modules.xr",
}

NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|@"(?:[^"]|"")*"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)
TOKEN = re.compile(
    r"[{}]|\bnamespace\s+(?P<namespace>[\w.]+)"
    r"|\b(?:class|struct|interface|enum)\s+(?P<type>\w+)(?:\s*:\s*(?P<base>\w+))?"
    r"|\bdelegate\s+[\w.<>\[\], ]+?\s(?P<delegate>\w+)\s*[<(]"
)
OURS = "Mua"
BY_FILE = {"MonoBehaviour", "ScriptableObject", "ScriptedImporter", "EditorWindow"}  # found by the name of their file


def faults(package: Package) -> Iterator[str]:
    """Each .cs file holds a type of its own name in our namespace, in an assembly, under symbols that can be."""
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
    if stem not in {name for _, name, _ in found} | {"AssemblyInfo"}:
        yield f"{where}: no type {stem}, expected one of the file's name"
    for namespace, name, base in found:
        if name != stem and base in BY_FILE:
            yield f"{where}: type {name}: {base}, which Unity looks for in {name}.cs"
        if not is_ours(namespace):
            yield f'{where}: type {name}: namespace "{namespace}", expected {OURS} or below it'


def outermost(text: str) -> Iterator[tuple[str, str, str]]:
    """Namespace, name and first base of the types that lie in no other; comments and strings are already gone."""
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
            yield ".".join(name for _, name in namespaces), token["type"] or token["delegate"], token["base"] or ""


def _assembly_of(package: Package, path: PurePosixPath) -> Assembly | None:
    by_folder = {assembly.path.parent: assembly for assembly in package.assemblies}
    return next((by_folder[folder] for folder in path.parents if folder in by_folder), None)


def is_ours(namespace: str) -> bool:
    return namespace == OURS or namespace.startswith(f"{OURS}.")
