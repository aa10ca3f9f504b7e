"""DXC's command line over the shared library that the PyPI package compushady brings.

Microsoft publishes no DXC for pip or apt. The interface is COM as of DXC 1.7 on Linux and macOS: a table of functions
that starts with three of IUnknown and the two destructors of a C++ class (dxcapi.h and WinAdapter.h of
https://github.com/microsoft/DirectXShaderCompiler); slots are counted from there.
"""

import ctypes
import importlib.util
import sys
import uuid
from ctypes import POINTER, addressof, byref, c_int32, c_size_t, c_uint32, c_void_p, c_wchar_p
from pathlib import Path
from typing import Any

LIBRARIES = ("libdxcompiler_x86_64.so.3.7", "libdxcompiler_aarch64.so.3.7", "libdxcompiler.3.7.dylib")
VERSION = "1.7"

# Class and interface identifiers of dxcapi.h.
CLASS_UTILS, UTILS = "6245d6af-66e0-48fd-80b4-4d271796748c", "4605c4cb-2019-492a-ada4-65f20bb7d67f"
CLASS_COMPILER, COMPILER = "73e22d93-e6ce-47f3-b5bf-f0664f39c1b0", "228b4687-5a6a-4730-900c-9702b2203f54"
RESULT = "58346cda-dde7-4497-9461-6f87af5e0659"

FIRST_SLOT = 5
CREATE_INCLUDE_HANDLER = 6  # of IDxcUtils
COMPILE = 0  # of IDxcCompiler3
STATUS, OBJECT, MESSAGES = 0, 1, 2  # of IDxcResult
POINTER_OF, SIZE_OF = 0, 1  # of IDxcBlob
UTF8 = 65001


class _Source(ctypes.Structure):
    """DxcBuffer."""

    _fields_ = (("text", ctypes.c_char_p), ("size", c_size_t), ("encoding", c_uint32))


def compile_file(path: Path, options: list[str]) -> tuple[bytes | None, str]:
    """The code of a file and what DXC says about it; no code where it does not compile."""
    library = ctypes.CDLL(str(_library()))
    utils, compiler = _instance(library, CLASS_UTILS, UTILS), _instance(library, CLASS_COMPILER, COMPILER)
    includes, result = c_void_p(), c_void_p()
    _call(utils, CREATE_INCLUDE_HANDLER, addressof(includes))
    text = path.read_bytes()
    source = _Source(text, len(text), UTF8)
    arguments = [str(path), *options]
    words = (c_wchar_p * len(arguments))(*arguments)
    guid = _guid(RESULT)
    _call(
        compiler,
        COMPILE,
        *(addressof(source), addressof(words), c_uint32(len(arguments)), includes.value),
        *(addressof(guid), addressof(result)),
    )
    status, code, messages = c_int32(), c_void_p(), c_void_p()
    _call(result, STATUS, addressof(status))
    _call(result, OBJECT, addressof(code))
    _call(result, MESSAGES, addressof(messages))
    return (_bytes(code) if status.value == 0 else None), _bytes(messages).rstrip(b"\0").decode()


def main() -> int:
    """Take dxc's arguments: options, -Fo OUTPUT and one file."""
    arguments = sys.argv[1:]
    if arguments == ["--version"]:
        print(f"dxcompiler {VERSION}")
        return 0
    at = arguments.index("-Fo")
    output = Path(arguments[at + 1])
    path = next(Path(argument) for argument in arguments[at + 2 :] if not argument.startswith("-"))
    code, messages = compile_file(path, [a for a in arguments if a not in ("-Fo", str(output), str(path))])
    print(messages, end="", file=sys.stderr)
    if code is None:
        return 1
    output.write_bytes(code)
    return 0


def _library() -> Path:
    """The library of this machine's kind in the folder of compushady, found without importing it."""
    spec = importlib.util.find_spec("compushady")
    folder = Path(spec.origin).parent / "backends" if spec and spec.origin else Path()
    found = [folder / name for name in LIBRARIES if (folder / name).is_file()]
    if not found:
        sys.exit("dxcompiler: the Python package compushady with its libdxcompiler is not installed")
    return found[0]


def _guid(text: str) -> Any:
    return (ctypes.c_ubyte * 16).from_buffer_copy(uuid.UUID(text).bytes_le)


def _instance(library: ctypes.CDLL, of: str, interface: str) -> c_void_p:
    made = c_void_p()
    if library.DxcCreateInstance(_guid(of), _guid(interface), byref(made)):
        sys.exit(f"dxcompiler: the library makes no object {of}")
    return made


def _call(instance: c_void_p, slot: int, *arguments: Any, result: Any = c_int32) -> Any:
    """Call a method of a COM object; Python integers are addresses."""
    table = ctypes.cast(ctypes.cast(instance, POINTER(c_void_p))[0], POINTER(c_void_p))
    kinds = [c_void_p if isinstance(argument, int) else type(argument) for argument in arguments]
    return ctypes.CFUNCTYPE(result, c_void_p, *kinds)(table[FIRST_SLOT + slot])(instance, *arguments)


def _bytes(blob: c_void_p) -> bytes:
    if not blob:
        return b""
    return ctypes.string_at(_call(blob, POINTER_OF, result=c_void_p), _call(blob, SIZE_OF, result=c_size_t))


if __name__ == "__main__":
    sys.exit(main())
