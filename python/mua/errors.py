"""The one error that a user may see: a sentence that names file, field and value."""

from pathlib import Path


class InputError(ValueError):
    """Raised where bad input enters; the command line prints it and exits with status 1.

    `details` are lines for who asks for more, such as the names of all joints.
    """

    def __init__(self, sentence: str = "", details: str = "") -> None:
        super().__init__(sentence)
        self.details = details

    def of(self, path: Path) -> "InputError":
        """The same error of a file."""
        return InputError(f"{path}: {self}", self.details)

    def in_full(self) -> "InputError":
        """The same error with its details after the sentence."""
        return InputError(f"{self}\n{self.details}" if self.details else str(self))
