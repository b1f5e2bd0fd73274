"""The cache of compiled code is no place that others can write to: numba unpickles what it finds there."""

from __future__ import annotations

import os
import stat
import tempfile
from pathlib import Path

import pytest

from tests.compiled import private_folder

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs modes of folders")


@pytest.fixture
def caches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's own caches, and another place for temporary folders."""
    (tmp_path / "temporary").mkdir()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    return tmp_path / "caches"


def test_the_same_folder_is_found_again(caches: Path) -> None:
    folder = private_folder("numba-1")
    assert folder.parent.parent == caches
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert private_folder("numba-1") == folder


@pytest.mark.parametrize("how", ["open to all", "link", "file"])
def test_a_folder_of_others_is_not_taken(how: str, caches: Path, tmp_path: Path) -> None:
    folder = private_folder("numba-1")
    folder.rmdir()
    if how == "open to all":
        folder.mkdir()
        folder.chmod(0o777)
    elif how == "link":
        folder.symlink_to(tmp_path)
    else:
        folder.write_bytes(b"")
    first, second = private_folder("numba-1"), private_folder("numba-1")
    assert first.parent == second.parent == tmp_path / "temporary"
    assert first != second
    assert stat.S_IMODE(first.stat().st_mode) == 0o700
