"""A store that was damaged, cut or never one is refused in one line; what is missing is answered again."""

from __future__ import annotations

import json
import shutil
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from leblanc.cli import main
from leblanc.studies.optimise.study import read_store as store_for_an_emulator
from leblanc.studies.sweep.store import STORE, read_arrays, read_store
from leblanc.studies.sweep.study import run_sweep
from meshes.errors import InputError
from tests.oracles.sweeps import STUDY, study_in, tree

Capture = pytest.CaptureFixture[str]
pytestmark = pytest.mark.usefixtures("quick")

#: Of all files or places each, and one of several at every landing.
some = partial(pytest.mark.parametrize, "every")
whole = pytest.param(1, marks=pytest.mark.slow)

TWO_BLOCKS = STUDY.replace("samples = 256", "samples = 128")


@pytest.fixture
def store(tmp_path: Path) -> Path:
    """The store of a finished sweep of two blocks."""
    run_sweep(study_in(tmp_path, TWO_BLOCKS), tmp_path / "out", workers=0)
    return tmp_path / "out" / STORE


def again(store: Path) -> None:
    """The same sweep once more."""
    run_sweep(study_in(store.parents[1], TWO_BLOCKS), store.parent, workers=0)


def files(store: Path) -> list[Path]:
    found = sorted(path for path in store.rglob("*") if path.is_file())
    assert len(found) > 60
    return found


@some([4, whole])
def test_no_flipped_byte_changes_a_number(store: Path, every: int) -> None:
    """Every file of the store, at its ends and at places between: refused, or of no consequence."""
    kept, values = tree(store), {name: a.values for name, a in read_arrays(store).arrays.items()}
    refused = 0
    for k, path in enumerate(files(store)):
        content = path.read_bytes()
        places = 0, len(content) // 3, 2 * len(content) // 3, len(content) - 1
        for place in places[k % every :: every]:
            changed = bytearray(content)
            changed[place] ^= 1 << place % 8
            path.write_bytes(changed)
            try:
                found = read_arrays(store)
            except InputError as error:
                assert "\n" not in str(error)
                refused += 1
            else:  # as a blank in place of another one
                for name, array in found.arrays.items():
                    assert np.array_equal(
                        array.values, values[name], equal_nan=array.values.dtype.kind == "f"
                    )
        path.write_bytes(content)
    assert refused > 200 / every
    assert tree(store) == kept


@some([5, whole])
def test_what_is_missing_is_answered_again(store: Path, every: int) -> None:
    """One chunk after the other, of every fifth variable; metadata are not made up."""
    kept = tree(store)
    metadata = [path for path in files(store) if path.name == "zarr.json"]
    chunks = [path for path in files(store) if path.name != "zarr.json"]
    for path in (metadata + chunks[::5])[::every]:
        content = path.read_bytes()
        path.unlink()
        if path.name == "zarr.json":
            with pytest.raises(InputError, match="store"):
                again(store)
            path.write_bytes(content)
        else:
            assert len(read_store(store).pending) == 1
            with pytest.raises(InputError, match="1 are pending"):
                read_arrays(store)
            again(store)
        assert tree(store) == kept


@some([4, whole])
def test_a_cut_file_is_refused(store: Path, every: int) -> None:
    for path in files(store)[::every]:
        content = path.read_bytes()
        for length in (0, len(content) - 1):
            path.write_bytes(content[:length])
            with pytest.raises(InputError):
                read_store(store)
        path.write_bytes(content)
    read_store(store)


def test_every_array_has_a_checksum(store: Path) -> None:
    for name, array in read_store(store).arrays.items():
        assert [type(codec).__name__ for codec in array.metadata.codecs][-1] == "Crc32cCodec", name


def test_what_is_no_store_is_refused(store: Path) -> None:
    """Another group of zarr, an older store, a file, chunks and metadata of another store."""
    import zarr

    foreign = store.parent / "foreign.zarr"
    zarr.create_group(foreign, zarr_format=3, attributes={"title": "another"})
    with pytest.raises(InputError, match="the store of a sweep"):
        read_store(foreign)
    (store.parent / "file.zarr").write_text("no folder")
    for path in (store.parent / "file.zarr", store.parent / "nothing.zarr", store / "speed"):
        with pytest.raises(InputError, match="the store of a sweep"):
            read_store(path)
    old = json.loads((store / "zarr.json").read_text())
    del old["attributes"]["checksums"], old["attributes"]["checksum"]
    (store / "zarr.json").write_text(json.dumps(old))
    with pytest.raises(InputError, match="older versions"):
        store_for_an_emulator(store)


def test_a_chunk_of_another_array_is_seen(store: Path) -> None:
    """A file that is whole, in the place of another: their lengths differ, or the text is none."""
    shutil.copy(store / "reason" / "c" / "0", store / "peak_growth" / "c" / "0")
    with pytest.raises(InputError):
        read_store(store)


def test_the_command_says_it_in_one_line(store: Path, capsys: Capture) -> None:
    study_in(store.parents[1], TWO_BLOCKS)
    chunk = store / "peak_amplitude" / "c" / "0"
    chunk.write_bytes(chunk.read_bytes()[:-1] + b"\0")
    arguments = ["sweep", str(store.parents[1] / "study.toml"), "--workers", "0", "--out", str(store.parent)]
    assert main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert str(chunk) in line and "undamaged" in line
    chunk.unlink()
    assert main(arguments) == 0
    assert main([*arguments, "--fresh"]) == 0
