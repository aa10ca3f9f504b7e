"""WGSL gets smaller and stays the same program; that it computes the same is for tests/parity."""

import gen_wgsl
import pytest
from wgsl_small import small, with_references, without_references

SHADERS = gen_wgsl.read()


def body(statements: str) -> str:
    """What becomes of the statements of a function of u_0 and v_0, there a and b."""
    written = small(f"fn f_0( u_0 : u32,  v_0 : f32)\n{{\n    {statements}\n}}\n")
    assert written.startswith("fn f_0(a:u32,b:f32){")
    return written.removeprefix("fn f_0(a:u32,b:f32){").removesuffix("}")


@pytest.mark.parametrize(
    ("statements", "expected"),
    [
        ("var i_0 : u32 = u_0 + u32(1);", "var c=a+1u;"),
        ("var x_0 : array<u32, i32(3)>; x_0[i32(2)] = u32(7);", "var c:array<u32,3>;c[2]=7u;"),
        ("var x_0 : f32 = v_0 - 0.00999999977648258f;", "var c=b-0.01f;"),
        ("var x_0 : f32 = max(v_0, 1.17549435082228751e-38f) * 1.0f;", "var c=max(b,1.1754944e-38f)*1f;"),
        ("var x_0 : vec3<f32> = vec3<f32>(vec3<i32>(i32(0)));", "var c=vec3f();"),
        ("for(;;){ if(u_0 < u32(3)) { } else { break; } g_0(); }", "for(;a<3u;){g_0();}"),
        ("for(;;){ g_0(); if(u_0 < u32(3)) { } else { break; } }", "for(;;){g_0();if(a<3u){}else{break;}}"),
        ("var x_0 : bool; if(g_0()) { x_0 = true; } else { x_0 = v_0 < 1.0f; }", "var c=g_0()||(b<1f);"),
        ("var x_0 : bool; if(g_0()) { x_0 = h_0(u_0); } else { x_0 = false; }", "var c=g_0()&&h_0(a);"),
        ("var x_0 : i32; if(g_0()) { x_0 = i32(-1); } else { x_0 = i32(1); }", "var c=select(1i,i32(-1),g_0());"),
        (
            "var x_0 : f32; if(g_0()) { x_0 = y_0[u_0]; } else { x_0 = v_0; }",
            "var c:f32;if(g_0()){c=y_0[a];}else{c=b;}",
        ),
        ("if(g_0()) { u_0 = u32(1); } else { v_0 = 1.0f; }", "if(g_0()){a=1u;}else{b=1f;}"),
        ("g_0(u_0); return;", "g_0(a);"),
        ("if(u_0 == u32(1)) { return; } g_0();", "if(a==1u){return;}g_0();"),
    ],
)
def test_statements_are_written_shorter(statements: str, expected: str) -> None:
    assert body(statements) == expected


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("((u_0) >> ((u32(16) * w_0)))", "a>>(16u*w_0)"),
        ("(w_0 + (u_0 + u32(1)))", "w_0+(a+1u)"),  # floats round after each sum
        ("- (- u_0)", "-(-a)"),
        ("u_0 - - w_0", "a- -w_0"),
        ("((g_0(u_0)).x) * (y_0[u_0])", "g_0(a).x*y_0[a]"),
        ("g_0((u_0 < w_0), (u_0 > w_0))", "g_0((a<w_0),(a>w_0))"),  # else the list of a template
        ("g_0((u_0 + w_0), (w_0))", "g_0(a+w_0,w_0)"),
        ("(*p_0)[i32(1)]", "(*p_0)[1]"),
        ("bitcast<f32>((u_0))", "bitcast<f32>(a)"),
        ("array<f32, i32(2)>( v_0, v_0 )", "array<f32,2>(b,b)"),
    ],
)
def test_parentheses_stay_where_they_count(value: str, expected: str) -> None:
    assert body(f"return {value};") == f"return{'' if expected[0] in '(-' else ' '}{expected};"


def test_members_and_functions_keep_their_names() -> None:
    code = (
        "fn own_0( own_1 : Bend_0) -> f32\n{\n    var turn_1 : f32 = own_1.turn_1;\n    return turn_1 + own_1.a;\n}\n"
    )
    assert small(code) == "fn own_0(a:Bend_0)->f32{var b=a.turn_1;return b+a.a;}"


def test_many_variables_get_names_of_their_own() -> None:
    count = 200
    found = body("".join(f"var x_{i} : u32 = u_0;" for i in range(count)))
    names = [each.removeprefix("var ").removesuffix("=a") for each in found.split(";")[:-1]]
    assert len({*names, "a", "b", "as", "do", "fn", "if", "of"}) == count + 7


def test_a_function_of_two_entry_points_gets_one_text() -> None:
    lines = [
        set(SHADERS[name].code.split("\n"))
        for name in [("inverse_dwt", "UpsampleTexels"), ("expressions", "BendTexels")]
    ]
    assert any(line.startswith("fn batchAt_0(") for line in lines[0] & lines[1])


@pytest.mark.parametrize("name", SHADERS, ids=lambda name: name[1])
def test_what_is_small_stays(name: tuple[str, str]) -> None:
    code = SHADERS[name].code
    assert [line for line in small(code).split("\n") if line not in code.split("\n")] == []


@pytest.mark.parametrize(
    ("code", "written"),
    [("a\nb\nc", "0-3"), ("x\nb\nc\ny", "x\n1-3\ny"), ("c\na\nb", "2-3\n0-2"), ("x", "x"), ("a\na", "0-1\n0-1")],
)
def test_lines_of_another_are_referred_to(code: str, written: str) -> None:
    other = "a\nb\nc"
    assert with_references(code, other) == written
    assert without_references(written, other) == code
