"""Names for array types in signatures; the comment beside each argument carries shape and unit."""

from typing import Any, TypeAlias

import numpy.typing as npt

Array: TypeAlias = npt.NDArray[Any]
