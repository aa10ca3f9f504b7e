"""The version of the package: files, checkpoints and shared pages name it."""

__version__ = "0.1.0"
