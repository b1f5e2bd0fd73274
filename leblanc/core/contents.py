"""What stands in a folder of results, and what wrote it: so that no other scene overwrites it unnoticed.

`contents.json` in the folder holds for each command the scene file, the scene's fingerprint and the files
with their checksums. A command removes what it wrote there before and does not write again, as long as
nobody has changed it, and says which files of other commands are of another state of the scene.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from leblanc.core.files import chosen_dir, native, out_dir, path_text, watched, writing
from meshes.errors import InputError
from meshes.files.foreign import open_regular

NAME = "contents.json"
_LONGEST = 10_000_000  # bytes that are read of it
_MANY = 5  # files that a message names


@dataclass
class Record:
    """What one command writes into a folder of results."""

    command: str  #: its name
    folder: Path | None = None  #: into which it writes; None until it has one
    source: str = ""  #: the scene or study file, as seen from the folder
    state: str = ""  #: fingerprint of the scene
    written: list[Path] = field(default_factory=list)  #: files, in their order
    previous: dict[str, Any] = field(default_factory=dict)  #: what the record said before
    #: the folder and those above it that were not there before, the innermost first
    fresh: Sequence[Path] = ()

    def open(self, folder: Path, source: Path, state: str, fresh: Sequence[Path] = ()) -> None:
        """Take a folder; from now on its record says that this command has not finished there."""
        self.folder, self.state, self.fresh = folder, state, fresh
        self.source = _seen_from(folder, source)
        self.previous, made = _read(folder), _made(folder)
        before = made.get(self.command, {})
        self._write(made, before.get("files", {}), finished=False)

    def abandon(self) -> None:
        """After a failure: take down what was written; where that is nothing, all is as it was before."""
        if self.folder is None:
            return
        if files := self._files():
            made = _made(self.folder)
            self._write(made, made.get(self.command, {}).get("files", {}) | files, finished=False)
        elif self.previous:
            self._say(self.previous)
        else:
            (self.folder / NAME).unlink(missing_ok=True)
            with suppress(OSError):  # one that holds something stays, and those above it
                for folder in self.fresh:
                    folder.rmdir()

    def close(self) -> list[str]:
        """Take down what was written; what of it is no longer true is removed.

        Returns
        -------
        What a user should know of the other files in the folder, a line each.
        """
        if self.folder is None:
            return []
        folder, made = self.folder, _made(self.folder)
        files = self._files()
        before = made.get(self.command, {}).get("files", {})
        removed = [name for name in before if name not in files and _removed(folder, name, before[name])]
        self._write(made, files, finished=True)
        lines = [f"{folder}: removed {_some(removed)}, of an earlier {self.command}"] if removed else []
        for command, entry in made.items():
            there = [name for name in entry["files"] if name not in files and _file(folder, name)]
            if there and not entry["current"]:
                lines.append(f"{folder}: made by {command} before the machine file changed: {_some(there)}")
            elif there and not entry.get("finished"):
                lines.append(f"{folder}: perhaps of two runs, since {command} was stopped: {_some(there)}")
        return lines

    def _files(self) -> dict[str, str]:
        """Files in the folder that were written, with their checksums."""
        own = [path for path in self.written if path.parent == self.folder and path.name != NAME]
        return {path_text(path.name): _checksum(path) for path in own if path.is_file()}

    def _write(self, made: dict[str, Any], files: Mapping[str, str], finished: bool) -> None:
        assert self.folder is not None
        own = {"scene": self.source, "digest": self.state, "finished": finished, "files": dict(files)}
        made[self.command] = own
        for entry in made.values():
            entry["current"] = entry["digest"] == self.state
        self._say({"scene": self.source, "made": made})

    def _say(self, content: Mapping[str, Any]) -> None:
        assert self.folder is not None
        with writing(self.folder / NAME) as part:
            part.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


_RECORD: ContextVar[Record | None] = ContextVar("record", default=None)


@contextmanager
def recording(command: str) -> Iterator[Record]:
    """Take down what a command writes within the block.

    Parameters
    ----------
    command : its name
    """
    record = Record(command)
    token = _RECORD.set(record)
    try:
        with watched(record.written.append):
            yield record
    except BaseException:
        record.abandon()
        raise
    finally:
        _RECORD.reset(token)


def results_dir(
    name: str, out: Path | None, source: Path, state: str, *files: str, force: bool = False, part: str = ""
) -> Path:
    """Folder for what a command makes of a scene, as `leblanc.core.files.out_dir`.

    `state` is the scene's fingerprint, `part` one of several things that the command writes beside each
    other. An `InputError` where neither `out` nor `force` is given and the
    folder holds what another scene of the same name gave, whose file is still there.
    """
    folder = chosen_dir(name, out)
    if out is None and not force and _is_of_another(folder, source):
        other = _read(folder)["scene"]
        allowed = f"another folder, or --force: this one holds what {other} gave, a scene of the same name"
        raise InputError("--out", path_text(folder), allowed)
    fresh = [path for path in (folder, *folder.parents) if not path.exists()]
    out_dir(name, out, *files)
    record = _RECORD.get()
    if record is not None:
        record.command = f"{record.command} {part}".rstrip()
        record.open(folder, source, state, fresh)
    return folder


def _is_of_another(folder: Path, source: Path) -> bool:
    """Whether a folder holds what another scene gave, whose file is still there."""
    other = _read(folder).get("scene")
    if not isinstance(other, str) or other == _seen_from(folder, source):
        return False
    file = _file(folder, other)
    return file is not None and not (source.exists() and file.samefile(source))


def _read(folder: Path) -> dict[str, Any]:
    """The record of a folder; empty if there is none that can be read."""
    try:
        with open_regular(folder / NAME) as file:
            found = json.loads(file.read(_LONGEST))
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _made(folder: Path) -> dict[str, Any]:
    """Entries by command, those alone that are as this module writes them."""
    made = _read(folder).get("made")
    return {
        command: entry
        for command, entry in (made.items() if isinstance(made, dict) else ())
        if isinstance(entry, dict)
        and isinstance(entry.get("digest"), str)
        and isinstance(entry.get("files"), dict)
    }


def _file(folder: Path, name: str) -> Path | None:
    """A file by its path from a folder, if there is one."""
    try:
        path = folder / native(name)
        return path if path.is_file() else None
    except (OSError, ValueError):
        return None


def _seen_from(folder: Path, source: Path) -> str:
    """Path of the scene file relative to the folder, the same on all systems."""
    try:
        return path_text(Path(os.path.relpath(source.resolve(), folder.resolve())).as_posix())
    except ValueError:  # on another drive
        return path_text(source.resolve())


def _checksum(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _removed(folder: Path, name: str, checksum: object) -> bool:
    """Remove a file of an earlier run, if it is in the folder itself and as it was written."""
    path = _file(folder, name)
    if path is None or path.parent != folder or path.is_symlink() or _checksum(path) != checksum:
        return False
    path.unlink()
    return True


def _some(names: list[str]) -> str:
    """The first of many names."""
    return ", ".join(names[:_MANY]) + (f" and {len(names) - _MANY} more" if len(names) > _MANY else "")
