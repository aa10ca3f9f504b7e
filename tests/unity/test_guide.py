"""docs/unity.md names only what there is: menus, fields, members, messages, files."""

import re

import pytest
from csharp import ROOT

GUIDE = (ROOT / "docs" / "unity.md").read_text()
SOURCES = {path: path.read_text() for path in sorted((ROOT / "unity-package").rglob("*.cs"))}
CODE = "\n".join(SOURCES.values())
RENDERER = SOURCES[ROOT / "unity-package" / "Runtime" / "AvatarRenderer.cs"]

MENU = re.compile(r"\*\*((?:MUA|GameObject) > [^*]+)\*\*")
ITEM = re.compile(r"MenuItem\((.+?)(?:,|\))")
JOINT = re.compile(r'"\s*\+\s*"')  # two literals that are one text
FIELD = re.compile(r"^\| ([A-Z]\w+(?: [A-Z]\w+)*) \| ", re.MULTILINE)
MEMBER = re.compile(r"avatar\.([A-Z]\w+)")
METHOD = re.compile(r"Mua\.Editor\.(\w+)\.(\w+)")
WORD = re.compile(r"(?<!\w)(-mua[A-Z]\w+|MUA-[A-Z]+(?: [A-Z]+)?)")
MARKER = re.compile(r"`(MUA [a-z ]+)`")
FILE = re.compile(r"`(?:tests/unity/)?((?:tests|tools|docs)/[\w/]+\.\w+|test_\w+\.py)`")


def section(title: str) -> str:
    """Text between a heading and the next one."""
    return GUIDE.split(f"## {title}\n")[1].split("\n## ")[0]


def menus() -> set[str]:
    """Paths of the package's menu items, constants put in."""
    constants = dict(re.findall(r'const string (\w+) = "([^"]*)"', CODE))
    found = set()
    for expression in ITEM.findall(CODE):
        parts = [part.strip() for part in expression.split(" + ")]
        found.add("".join(part.strip('"') if part.startswith('"') else constants[part] for part in parts))
    return found


@pytest.mark.parametrize("menu", sorted(set(MENU.findall(GUIDE))))
def test_menus_exist(menu: str) -> None:
    assert menu.replace(" > ", "/") in menus()


def test_every_menu_item_is_in_the_guide() -> None:
    assert {path.replace("/", " > ") for path in menus()} == set(MENU.findall(GUIDE))


def test_every_test_is_in_the_readme_beside_it() -> None:
    folder = ROOT / "tests" / "unity"
    named = set(re.findall(r"`(test_\w+\.py)`", (folder / "README.md").read_text()))
    assert named == {path.name for path in folder.glob("test_*.py")}


def test_fields_are_those_of_the_component() -> None:
    serialized = re.findall(r"private \w+ (\w+) = [^;]+;", RENDERER.split("private AvatarInstance")[0])
    labels = [re.sub(r"([A-Z])", r" \1", name).title() for name in serialized]
    assert FIELD.findall(section("The component")) == labels


@pytest.mark.parametrize("member", sorted(set(MEMBER.findall(GUIDE))))
def test_members_are_public(member: str) -> None:
    assert re.search(rf"public [\w<>]+ {member}\b", RENDERER)


@pytest.mark.parametrize(("type_name", "method"), sorted(set(METHOD.findall(GUIDE))))
def test_methods_of_the_command_line_exist(type_name: str, method: str) -> None:
    assert f"public static void {method}()" in SOURCES[ROOT / "unity-package" / "Editor" / f"{type_name}.cs"]


@pytest.mark.parametrize("word", sorted(set(WORD.findall(GUIDE))))
def test_words_of_command_line_and_log_exist(word: str) -> None:
    assert word in CODE


@pytest.mark.parametrize("marker", sorted(set(MARKER.findall(GUIDE))))
def test_markers_exist(marker: str) -> None:
    assert f'"{marker}"' in CODE


@pytest.mark.parametrize("name", sorted(set(FILE.findall(GUIDE))))
def test_files_exist(name: str) -> None:
    assert (ROOT / name).is_file() or (ROOT / "tests" / "unity" / name).is_file()


def messages() -> list[str]:
    """First cells of the table of faults that the package itself says."""
    rows = re.findall(r"^\| (.+?) \| ", section("When it does not work"), re.MULTILINE)
    return [row for row in rows if "..." in row or row.endswith((".", ":"))]


@pytest.mark.parametrize("message", [message for message in messages() if not message.startswith("`")])
def test_messages_are_those_of_the_package(message: str) -> None:
    """Part by part: what stands between two `...` is in one string of the source."""
    texts = JOINT.sub("", CODE)
    for part in message.split("..."):
        assert part.strip() in texts, part
