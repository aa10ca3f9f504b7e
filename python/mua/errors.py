"""The one error that a user may see: a sentence that names file, field and value."""


class InputError(ValueError):
    """Raised where bad input enters; the command line prints it and exits with status 1."""
