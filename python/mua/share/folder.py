"""Writes a site as a folder, atomically, in place of an earlier one."""

import os
import shutil
from pathlib import Path

from mua.errors import InputError
from mua.files.write import missing_directory, refused
from mua.share.site import PAGE, Content, Site

MARK = b'<meta name="generator" content="mua">'  # marks a page that may be replaced


def require_replaceable(folder: Path) -> None:
    """Raise InputError, before any work, where the folder holds files that this command did not write."""
    missing_directory(folder.parent, option="-o")
    if not folder.exists():
        return
    if not folder.is_dir():
        raise InputError(f"-o {folder}: is a file, expected a folder to write; --single-file writes one file")
    page = folder / PAGE
    if any(folder.iterdir()) and not (page.is_file() and MARK in page.read_bytes()):
        raise InputError(f"-o {folder}: holds other files, which would be lost; expected a new folder or a shared one")


def write_folder(folder: Path, site: Site) -> None:
    """Write all files of a site, then put the folder in place.

    A reader sees the old folder, the new one or, for a moment between two renames, none. Errors: InputError where the
    system refuses to write.
    """
    place = folder.absolute()
    fresh, old = (place.with_name(f".{place.name}.{os.getpid()}.{kind}") for kind in ("part", "old"))
    try:
        for path, content in site.items():
            _write(fresh / path, content)
        if place.exists():
            place.replace(old)
        fresh.replace(place)
    except OSError as error:
        if old.exists() and not place.exists():
            old.replace(place)
        raise refused(folder, error) from error
    finally:
        for left in (fresh, old):
            shutil.rmtree(left, ignore_errors=True)


def _write(path: Path, content: Content) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        shutil.copyfile(content, path)
