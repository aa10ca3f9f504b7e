"""An argument of a public function that is an option of a command too: declared once, checked the same way in both."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from inspect import Parameter, signature
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, ForwardRef, Literal, Union, get_args, get_origin

from mua.arguments import as_names, as_path, as_paths, finite_array, one_of, whole_number
from mua.errors import InputError


@dataclass(frozen=True)
class Option:
    """Metadata of an Annotated argument; name, type and default are those of the argument.

    Example:

        def bake(*, frames: Annotated[int | None, Option("Number of frames.", least=1)] = None) -> None: ...
    """

    help: str
    default: str | bool = True  # what --help says of the default, where that is not the value itself
    short: str | None = None  # such as -o
    metavar: str | None = None
    choices: Sequence[str] = ()  # names that --help lists and shells complete, of an argument that is no Literal
    least: float | None = None
    most: float | None = None
    multiple: int | None = None  # of which a number must be one
    unit: str = ""


def declared(function: Callable[..., object]) -> Iterator[tuple[Parameter, Any, Option]]:
    """The arguments of a function that are options, each with its type and declaration."""
    for argument in signature(function).parameters.values():
        for option in getattr(argument.annotation, "__metadata__", ()):
            if isinstance(option, Option):
                yield argument, get_args(argument.annotation)[0], option


def read_options(function: Callable[..., object], given: Mapping[str, Any]) -> dict[str, Any]:
    """The options among the arguments `given` to a function: paths as Path, one or several as a tuple.

    Raises InputError for a value outside of what is declared.
    """
    return {
        argument.name: _read(given[argument.name], argument.name, kind, option)
        for argument, kind, option in declared(function)
    }


def members(kind: Any) -> tuple[Any, ...]:
    """The types of a union, or the one that is none."""
    return get_args(kind) if get_origin(kind) in (Union, UnionType) else (kind,)


def _elements(kind: Any) -> list[Any]:
    """The types of one value, of an option that may be repeated those of each."""
    parts = [members(get_args(member)[0]) if get_origin(member) is Sequence else (member,) for member in members(kind)]
    return [part for several in parts for part in several]


def takes_path(kind: Any) -> bool:
    return any(element in (Path, os.PathLike[str]) for element in _elements(kind))


def takes_several(kind: Any) -> bool:
    """Whether an option may be repeated."""
    return any(get_origin(member) is Sequence for member in members(kind))


def takes_numbers(kind: Any) -> bool:
    return takes_several(kind) and float in _elements(kind)


def _read(value: Any, name: str, kind: Any, option: Option) -> Any:
    kinds = members(kind)
    if isinstance(kind, ForwardRef) or (value is None and NoneType in kinds):
        return value  # the class that the reference names is not loaded yet
    if isinstance(value, Mapping) and any(get_origin(member) is Mapping for member in kinds):
        return value
    if takes_numbers(kind):
        return tuple(_in_range(float(finite_array(one, name, ())), name, option) for one in value)
    if takes_several(kind) and takes_path(kind):
        return as_paths(value, name)
    if takes_several(kind):
        number = isinstance(value, int) and not isinstance(value, bool) and int in kinds
        return _known(as_names(str(value) if number else value, name), name, option)
    if takes_path(kind):
        return as_path(value, name)
    names = [choice for member in kinds if get_origin(member) is Literal for choice in get_args(member)]
    if names:
        return one_of(value, name, (*([None] if NoneType in kinds else []), *names))
    if int in kinds:
        return _in_range(whole_number(value, name), name, option)
    return _in_range(float(finite_array(value, name, ())), name, option) if float in kinds else value


def _known(values: tuple[str, ...], name: str, option: Option) -> tuple[str, ...]:
    for value in values:
        if option.choices and value not in option.choices:
            raise InputError(f"{_flag(name)} {value}: expected one of {', '.join(option.choices)}")
    return values


def _in_range(value: float, name: str, option: Option) -> float:
    low, high, multiple = option.least, option.most, option.multiple
    in_bounds = (low is None or low <= value) and (high is None or value <= high)
    if in_bounds and (multiple is None or value % multiple == 0):
        return value
    if multiple is not None:
        expected = f"a multiple of {multiple} from {low:g} on"
    elif high is not None:
        expected = f"{low:g} to {high:g}"
    else:
        expected = f"at least {low:g}" if low else "0 or more"
    shown = value if isinstance(value, int) else f"{value:g}"
    raise InputError(f"{_flag(name)} {shown}: expected {expected} {option.unit}".rstrip())


def _flag(name: str) -> str:
    return f"--{name.replace('_', '-')}"
