"""Folders and files that are written: names that every file system takes, files that are whole or absent."""

from __future__ import annotations

import errno
import os
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import partial
from pathlib import Path

from leblanc.core.interrupts import at_forced_end
from meshes.errors import InputError

_WATCHES: ContextVar[tuple[Callable[[Path], None], ...]] = ContextVar("watches", default=())
_LONGEST_NAME = 200  # bytes; file systems allow 255
_RESERVED = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?", re.IGNORECASE)  # on Windows


def path_of(given: str | os.PathLike[str] | None, name: str) -> Path | None:
    """The path of a file that a question names, None without one."""
    if given is None:
        return None
    try:
        return Path(given)
    except TypeError as error:
        raise InputError(name, repr(given), "the path of a file") from error


def chosen_dir(scene_name: str, out: Path | None) -> Path:
    """Folder for the files of a command: the user's choice, or out/<scene name>."""
    return Path("out") / native(safe_name(scene_name)) if out is None else out


def out_dir(scene_name: str, out: Path | None, *names: str) -> Path:
    """Folder for the files of a command, made if need be and tried for writing.

    Parameters
    ----------
    scene_name : names the folder out/<scene name> where the user chose none
    out : the user's choice
    names : of files that will be written there, tried as well

    Raises
    ------
    OSError : it cannot be made or written; carries the path
    """
    folder = chosen_dir(scene_name, out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with _naming(folder), tempfile.TemporaryFile(dir=folder):
            pass  # better now than after the work
    except PermissionError as error:
        if out is None:
            error.strerror = f"{error.strerror}; --out DIR chooses another folder"
        raise
    for name in names:
        require_writable(folder / name)
    return folder


def require_writable(path: Path) -> None:
    """Refuse a file that cannot be written or replaced there, or is protected.

    Better now than after the work. Its folder is made; the OSError carries the path.
    """
    with _naming(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        _require_free(path)
        with tempfile.TemporaryFile(dir=path.parent):
            pass


def _require_free(path: Path) -> None:
    """Raise where a name is too long, or stands for a folder or a protected file."""
    try:
        path.lstat()
    except FileNotFoundError:
        return
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not os.access(path, os.W_OK) and path.exists():
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))


def safe_name(name: str) -> str:
    """The name with what file systems refuse replaced by underscores."""
    kept = "".join("_" if letter in '/\\:*?"<>|' or not letter.isprintable() else letter for letter in name)
    short = kept.encode()[:_LONGEST_NAME].decode(errors="ignore").strip(". ")
    return f"_{short}" if not short or _RESERVED.fullmatch(short) else short


def native(path: str) -> str:
    """A path from a text, as this process names the file whose name is that text in UTF-8.

    They differ where the locale has no such letters, as the locale C of batch jobs.
    """
    return os.fsdecode(path.encode("utf-8", "surrogateescape"))


def path_text(path: str | Path) -> str:
    """The text of a path, the inverse of `native`; bytes that are no UTF-8 are written as escapes."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


@contextmanager
def writing(path: Path) -> Iterator[Path]:
    """Path to write to; what was written takes its place at `path` when the block ends well.

    Until then, and if the block fails, whatever stood at `path` stands there untouched: no reader sees half a
    file.

    Parameters
    ----------
    path : of the file; its folder is made if it is missing

    Raises
    ------
    OSError : it cannot be written; carries the path
    """
    stem, suffix = native(path_text(path.stem).encode()[:100].decode(errors="ignore")), path.suffix
    # The ending tells libraries what to write; one as long as a name is none that they know.
    part = path.with_name(f".{stem}.{os.getpid()}.part{suffix if len(suffix) < 20 else ''}")
    remove = partial(part.unlink, missing_ok=True)
    at_forced_end.append(remove)
    try:
        with _naming(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            _require_free(path)
            yield part
            part.replace(path)
        for watch in _WATCHES.get():
            watch(path)
    finally:
        remove()
        at_forced_end.remove(remove)


@contextmanager
def watched(watch: Callable[[Path], None]) -> Iterator[None]:
    """Tell of each file that is written whole within the block."""
    token = _WATCHES.set((*_WATCHES.get(), watch))
    try:
        yield
    finally:
        _WATCHES.reset(token)


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Give an error of the file system the path that the user knows."""
    try:
        yield
    except OSError as error:
        error.filename, error.filename2 = str(path), None
        raise
