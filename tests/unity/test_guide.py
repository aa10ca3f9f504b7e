"""docs/unity.md names what the compiled package has: menus, fields, members, messages; its scripts compile."""

import re
from pathlib import Path

import pytest
from csharp import ROOT, CSharp
from package_compiler import Compiler
from package_content import Content

GUIDE = (ROOT / "docs" / "unity.md").read_text()
PAGES = GUIDE + (ROOT / "docs" / "research" / "unity.md").read_text()

MENU = re.compile(r"\*\*((?:MUA|GameObject) > [^*]+)\*\*")
FIELD = re.compile(r"^\| ([A-Z]\w+(?: [A-Z]\w+)*) \| ", re.MULTILINE)
MEMBER = re.compile(r"avatar\.([A-Z]\w+)")
COMMAND = re.compile(r"Mua\.Editor\.\w+\.\w+")
WORD = re.compile(r"(?<!\w)(-mua[A-Z]\w+|MUA-[A-Z]+(?: [A-Z]+)?)")
MARKER = re.compile(r"`(MUA [a-z ]+)`")
COMPONENT = "Mua.AvatarRenderer."
SCRIPT = re.compile(r"(?:^ {4}.*\n|^\n(?= {4}))+", re.MULTILINE)
CALLS = re.compile(r"`((?:avatar\.)?[A-Z]?\w+(?:<\w+>)?\([^`)]*\))`")
FRAME = """
using System.Collections; using Mua; using UnityEngine;
using UnityEngine.AddressableAssets; using UnityEngine.ResourceManagement.AsyncOperations;

namespace UnityEngine.ResourceManagement.AsyncOperations
{
    public enum AsyncOperationStatus { None, Succeeded, Failed }
    public struct AsyncOperationHandle<T> { public AsyncOperationStatus Status => default; public T Result => default; }
}

namespace UnityEngine.AddressableAssets
{
    public static class Addressables
    {
        public static AsyncOperationHandle<T> LoadAssetAsync<T>(object key) => default;
        public static void Release<T>(AsyncOperationHandle<T> handle) {}
    }
}

namespace UnityEngine
{
    public class AssetBundleRequest : AsyncOperation { public Object asset => null; }
    public class AssetBundle : Object { public AssetBundleRequest LoadAssetAsync<T>(string name) => null; }
}

public sealed class Shown : MonoBehaviour
{
#pragma warning disable 649
PARTS
}
"""


def section(title: str) -> str:
    """Text between a heading and the next one."""
    return GUIDE.split(f"## {title}\n")[1].split("\n## ")[0]


def label(field: str) -> str:
    """A field as the inspector names it: spreadDecode is Spread Decode."""
    return re.sub(r"([A-Z])", r" \1", field).title()


def test_menus_are_those_of_the_editor(content: Content) -> None:
    assert {path.replace("/", " > ") for path in content.declared["menu"]} == set(MENU.findall(GUIDE))


def test_fields_are_those_of_the_component_in_their_order(content: Content) -> None:
    names = [name for name in content.declared["serialized"] if name.startswith(COMPONENT)]
    assert FIELD.findall(section("The component")) == [label(name.removeprefix(COMPONENT)) for name in names]


@pytest.mark.parametrize("member", sorted(set(MEMBER.findall(GUIDE))))
def test_members_are_public(content: Content, member: str) -> None:
    assert f"{COMPONENT}{member}" in content.declared["member"]


@pytest.mark.parametrize("method", sorted(set(COMMAND.findall(PAGES))))
def test_methods_of_the_command_line_can_be_called_by_the_editor(content: Content, method: str) -> None:
    assert method in content.declared["command"]


@pytest.mark.parametrize("text", sorted({*WORD.findall(PAGES), *MARKER.findall(PAGES)}))
def test_arguments_log_lines_and_markers_exist(content: Content, text: str) -> None:
    assert content.says(text)


def test_scripts_and_calls_compile(csharp: CSharp, tmp_path: Path) -> None:
    """Those that the guide shows as they stand; its calls in a sentence with what they name as arguments."""
    shown = [block for block in SCRIPT.findall(GUIDE) if "avatar." in block]
    calls = sorted(set(CALLS.findall(GUIDE)))
    assert (len(shown), len(calls)) == (2, 9)
    component, loading = shown
    given = "string name = null, avatarJoint = null, rigJoint = null; float weight = 0; byte[] bytes = null;"
    given += "AvatarAsset asset = null;"
    owner = {"Map": "rig.", "TakeRest": "rig.", "AddComponent": "gameObject."}
    said = [f"{owner.get(re.split(r'[(<]', call)[0], '')}{call};" for call in calls]
    parts = [
        component,
        f"private AssetBundle bundle; private IEnumerator Bring() {{ {loading} }}",
        f"private void Calls(RetargetedRig rig) {{ {given} {' '.join(said)} }}",
    ]
    source = tmp_path / "Shown.cs"
    source.write_text(FRAME.replace("PARTS", "\n".join(parts)))
    compiler = Compiler(csharp, "quest", packages=True)
    references = [compiler.built(name) for name in ("UnityEngine", "Mua.Avatar")]
    csharp.build([source], library=True, references=references)


def messages() -> list[str]:
    """First cells of the table of faults that the package itself reports."""
    rows = re.findall(r"^\| (.+?) \| ", section("When it does not work"), re.MULTILINE)
    return [row for row in rows if ("..." in row or row.endswith((".", ":"))) and not row.startswith("`")]


@pytest.mark.parametrize("message", messages())
def test_messages_are_those_of_the_package(content: Content, message: str) -> None:
    """Part by part: what stands between two `...`."""
    for part in message.split("..."):
        assert content.says(part.strip()), part


def test_every_test_is_in_the_readme_beside_it() -> None:
    folder = ROOT / "tests" / "unity"
    named = set(re.findall(r"`(test_\w+\.py)`", (folder / "README.md").read_text()))
    assert named == {path.name for path in folder.glob("test_*.py")}
