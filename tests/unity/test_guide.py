"""docs/unity.md names what the compiled package has: menus, fields, members, messages; and files of the repository."""

import re

import pytest
from csharp import ROOT
from package_content import Content

GUIDE = (ROOT / "docs" / "unity.md").read_text()

MENU = re.compile(r"\*\*((?:MUA|GameObject) > [^*]+)\*\*")
FIELD = re.compile(r"^\| ([A-Z]\w+(?: [A-Z]\w+)*) \| ", re.MULTILINE)
MEMBER = re.compile(r"avatar\.([A-Z]\w+)")
COMMAND = re.compile(r"Mua\.Editor\.\w+\.\w+")
WORD = re.compile(r"(?<!\w)(-mua[A-Z]\w+|MUA-[A-Z]+(?: [A-Z]+)?)")
MARKER = re.compile(r"`(MUA [a-z ]+)`")
COMPONENT = "Mua.AvatarRenderer."


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


@pytest.mark.parametrize("method", sorted(set(COMMAND.findall(GUIDE))))
def test_methods_of_the_command_line_can_be_called_by_the_editor(content: Content, method: str) -> None:
    assert method in content.declared["command"]


@pytest.mark.parametrize("text", sorted({*WORD.findall(GUIDE), *MARKER.findall(GUIDE)}))
def test_arguments_log_lines_and_markers_exist(content: Content, text: str) -> None:
    assert content.says(text)


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
