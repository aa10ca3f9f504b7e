"""tools/check_engine_api.py: what the package uses of the engine, held against stand-ins with planted faults."""

from collections.abc import Iterator
from pathlib import Path

import check_engine_api
import csharp_source
import pytest
from check_engine_api import Found, Used, look_up
from csharp import STAND_INS, CSharp
from package_compiler import OLDEST, engine_symbols

ENGINE = STAND_INS / "UnityEngine"


@pytest.fixture(scope="module")
def used(csharp: CSharp) -> dict[str, Used]:
    """What the package uses on the oldest engine, by its words."""
    members = check_engine_api.named(check_engine_api.used_members(csharp, OLDEST), OLDEST)
    return {str(member): member for member in members}


def found(used: dict[str, Used], folder: Path) -> Iterator[Found]:
    types = csharp_source.read([folder], {"UNITY_EDITOR", *engine_symbols(OLDEST)})
    yield from (look_up(types, member) for member in used.values())


def test_a_type_that_no_source_has_is_named_as_unknown(used: dict[str, Used]) -> None:
    outcomes = {str(each.used): each.outcome for each in found(used, ENGINE)}
    assert outcomes["UnityEngine.Camera"] == "same"
    assert outcomes["NUnit.Framework.TestAttribute"] == "unknown"


FAULTS = {  # what a newer engine may do: file, its text, the other text, member, outcome
    "a member that is gone": (
        "Pipeline.cs", "widthScaleFactor", "widthBufferScale",
        "get UnityEngine.ScalableBufferManager.widthScaleFactor", "absent",
    ),
    "a setter that is gone": (
        "Camera.cs", "bool allowHDR { get; set; }", "bool allowHDR { get; }",
        "set UnityEngine.Camera.allowHDR", "different",
    ),
    "a setter that is not public": (
        "Camera.cs", "bool allowHDR { get; set; }", "bool allowHDR { get; internal set; }",
        "set UnityEngine.Camera.allowHDR", "different",
    ),
    "a setter that is an error": (
        "Camera.cs", "bool allowHDR { get; set; }", 'bool allowHDR { get; [Obsolete("no", true)] set; }',
        "set UnityEngine.Camera.allowHDR", "different",
    ),
    "another type": (
        "Camera.cs", "public float nearClipPlane", "public double nearClipPlane",
        "get UnityEngine.Camera.nearClipPlane", "different",
    ),
    "a parameter more": (
        "Object.cs", "void DontDestroyOnLoad(Object target)", "void DontDestroyOnLoad(Object target, int start)",
        "UnityEngine.Object.DontDestroyOnLoad(Object)", "different",
    ),
    "a parameter more that may be left out": (
        "Object.cs", "void DontDestroyOnLoad(Object target)", "void DontDestroyOnLoad(Object target, int start = 0)",
        "UnityEngine.Object.DontDestroyOnLoad(Object)", "same",
    ),
    "another name in an enum": (
        "Camera.cs", "SolidColor", "PlainColor", "UnityEngine.CameraClearFlags.SolidColor", "absent",
    ),
    "a member that is deprecated": (
        "Object.cs", "public static void DontDestroyOnLoad", '[Obsolete("soon")] public static void DontDestroyOnLoad',
        "UnityEngine.Object.DontDestroyOnLoad(Object)", "deprecated",
    ),
}  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS)
def test_what_an_engine_has_otherwise_is_found(used: dict[str, Used], tmp_path: Path, fault: str) -> None:
    file, text, other, member, outcome = FAULTS[fault]
    for path in ENGINE.glob("*.cs"):
        content = path.read_text()
        assert path.name != file or text in content, f"{file} has no {text}"
        (tmp_path / path.name).write_text(content.replace(text, other) if path.name == file else content)
    outcomes = {str(each.used): each.outcome for each in found(used, tmp_path)}
    assert outcomes[member] == outcome


@pytest.mark.usefixtures("csharp")
def test_the_command_tells_what_is_gone_and_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file, text, other, member, outcome = FAULTS["a member that is gone"]
    (tmp_path / file).write_text((ENGINE / file).read_text().replace(text, other))
    monkeypatch.setattr("sys.argv", ["check_engine_api.py", str(tmp_path)])
    assert check_engine_api.main() == 1
    printed = capsys.readouterr().out
    assert f"{outcome}: {member}" in printed
    assert "same: " not in printed
    monkeypatch.setattr("sys.argv", ["check_engine_api.py", "--all", "--engine", OLDEST, str(ENGINE)])
    assert check_engine_api.main() == 0
    assert f"same: {member}" in capsys.readouterr().out
    monkeypatch.setattr("sys.argv", ["check_engine_api.py", str(tmp_path / "gone")])
    with pytest.raises(SystemExit):
        check_engine_api.main()
    assert "gone: no such folder" in capsys.readouterr().err


def test_members_that_only_a_newer_engine_has_are_used_there(csharp: CSharp) -> None:
    before, after = (
        {str(member) for member in check_engine_api.used_members(csharp, engine)} for engine in (OLDEST, "6000.3")
    )
    assert "UnityEditor.DragAndDrop.AddDropHandlerV2(SceneDropHandler)" in after - before
    assert "UnityEditor.DragAndDrop.AddDropHandler(SceneDropHandler)" in before - after


SOURCE = """
[assembly: Some("x")]
using Thing = Elsewhere.Thing;
namespace A.B
{
    /* class Nothing { */
    public abstract class Holder<T> : Base<T>, IOther where T : struct
    {
        public T value; // of type { T
        public extern int Count { [Native("(")] get; }
        protected internal Thing[] all { private get; set; }
        internal static string Hidden() => "}";
        public Dictionary<string, List<T>> Map<U>(ref U key, params int?[] more) where U : class { return null; }
        public event System.Action<T> changed;
        int IOther.Secret() { return 0; }
        public delegate void Told(in T what);
        public enum Kind : byte { One, Two = 5, Three }
#if NEVER
        public int never;
#elif UNITY_EDITOR && (A || !B)
        public const int k_Sometimes = 3, k_Other = 4;
#endif
    }
}
"""


def test_declarations_are_read_as_a_compiler_reads_them(tmp_path: Path) -> None:
    (tmp_path / "Source.cs").write_text(SOURCE)
    types = csharp_source.read([tmp_path], {"UNITY_EDITOR"})
    holder = types["A.B.Holder`1"]
    members = {member.name: member for member in holder.members}
    assert holder.bases == ["Base<!0>", "IOther"]
    assert set(members) == {"value", "Count", "all", "Hidden", "Map", "changed", "k_Sometimes", "k_Other"}
    assert (members["value"].value, members["all"].value, members["Count"].kinds) == ("!0", "Thing[]", {"get"})
    assert (members["all"].closed, members["Hidden"].is_open, members["Hidden"].is_static) == ({"get"}, False, True)
    assert members["Map"].value == "Dictionary<string,List<!0>>"
    assert members["Map"].parameters == ("ref !!0", "Nullable<int>[]")
    assert members["k_Other"].number == "4"
    assert types["A.B.Holder`1.Told"].kind == "delegate"
    assert [member.number for member in types["A.B.Holder`1.Kind"].members] == ["0", "5", "5+1"]


INHERITED = """
namespace A
{
    public class Plain : Near, Elsewhere<int> { }
    public class Elsewhere<T> { public T given; }
    public class Near { public int kept; internal int hidden; }
}
namespace C.D { public class Near { public int other; } }
"""


@pytest.mark.parametrize(
    ("name", "value", "outcome"),
    [("kept", "int", "same"), ("kept", "float", "different"), ("given", "int", "same"), ("given", "!0", "different"),
     ("hidden", "int", "different"), ("other", "int", "absent")],
)  # fmt: skip
def test_members_are_those_of_the_types_that_a_type_inherits_from(
    tmp_path: Path, name: str, value: str, outcome: str
) -> None:
    (tmp_path / "Source.cs").write_text(INHERITED)
    types = csharp_source.read([tmp_path], set())
    used = Used("field", "A.Plain", name, is_static=False, value=value, parameters=())
    assert look_up(types, used).outcome == outcome
