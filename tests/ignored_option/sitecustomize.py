"""Python that starts with this folder on its path ignores one option: $IGNORED_OPTION is MODULE:FUNCTION:ARGUMENT.

Whatever the function is given for that argument, it gets the default.
"""

import functools
import importlib.util
import inspect
import os
import sys
from collections.abc import Callable
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from typing import Any

MODULE, FUNCTION, ARGUMENT = os.environ["IGNORED_OPTION"].split(":")


class Finder(MetaPathFinder):
    """Finds the module and changes its function as soon as it is loaded."""

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        if name != MODULE:
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        assert spec
        assert spec.loader
        load = spec.loader.exec_module

        def changed(module: Any) -> None:
            load(module)
            setattr(module, FUNCTION, ignoring(getattr(module, FUNCTION)))

        spec.loader.exec_module = changed  # type: ignore[method-assign]
        return spec


def ignoring(function: Callable[..., Any]) -> Callable[..., Any]:
    """The same function without that argument."""
    signature = inspect.signature(function)

    @functools.wraps(function)
    def run(*arguments: Any, **given: Any) -> Any:
        bound = signature.bind(*arguments, **given)
        bound.arguments.pop(ARGUMENT, None)
        bound.apply_defaults()
        return function(*bound.args, **bound.kwargs)

    return run


sys.meta_path.insert(0, Finder())
