"""Mesh files that were made to harm whoever reads them are refused in one line, and before they do."""

from __future__ import annotations

import base64
import os
import socket
import struct
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import h5py
import numpy as np
import pytest

from meshes.errors import InputError
from meshes.files import drawing, foreign
from meshes.files.exchange import read_section, write_section
from meshes.files.foreign import open_regular
from meshes.files.outline import outline_section
from meshes.section import Section

SQUARE = Section(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), np.array([[0, 1, 2], [0, 2, 3]]))


def refused(path: Path, said: str) -> None:
    """The file is refused with one line that holds these words."""
    with pytest.raises(InputError, match=said) as caught:
        read_section(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


# -- what is no file -----------------------------------------------------------------------------------------


def pipe(path: Path) -> None:
    os.mkfifo(path)


def device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def a_socket(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(str(path))


def loop(path: Path) -> None:
    path.symlink_to(path.name)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
@pytest.mark.parametrize("make", [pipe, device, a_socket, loop, Path.mkdir], ids=lambda make: make.__name__)
@pytest.mark.parametrize("ending", [".msh", ".vtu", ".xdmf", ".dxf", ".step"])
def test_what_is_no_regular_file_is_not_waited_for(
    make: Callable[[Path], None], ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # the path of a socket has to be short
    path = Path(f"m{ending}")
    make(path)
    with pytest.raises(InputError, match="must be an existing"):
        (read_section if ending in (".msh", ".vtu", ".xdmf") else outline_section)(path)
    with pytest.raises(OSError, match=r"egular|directory|symbolic"):
        open_regular(path)


def test_a_file_that_is_too_long(tmp_path: Path) -> None:
    path = tmp_path / "long.msh"
    with path.open("wb") as file:
        file.truncate(foreign.MAX_BYTES + 1)
    refused(path, "at most 100 MB")


# -- few bytes that become many ------------------------------------------------------------------------------


def vtu(data: str, header: str = "UInt32", before: str = "", appended: bytes = b"") -> bytes:
    """A .vtu file with three points of these data."""
    return (
        f'<?xml version="1.0"?>{before}<VTKFile type="UnstructuredGrid" version="0.1" '
        f'byte_order="LittleEndian" header_type="{header}" compressor="vtkZLibDataCompressor">'
        f'<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1"><Points>{data}</Points>'
        "</Piece></UnstructuredGrid>"
    ).encode() + (appended + b"</VTKFile>")


@cache
def packed(count: int, word: str = "<I") -> bytes:
    """So many zeros as VTK packs them."""
    squeeze = zlib.compressobj(9)
    data = b"".join(squeeze.compress(bytes(2**20)) for _ in range(count // 2**20)) + squeeze.flush()
    return struct.pack(f"<4{word[-1]}", 1, 2**20, 0, len(data)) + data


needs_limits = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is limited on Linux")


@needs_limits
@pytest.mark.parametrize("raw", [False, True], ids=["in text", "appended"])
def test_a_bomb_is_not_unpacked(raw: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foreign, "MAX_MEMORY", 150_000_000)
    bomb, path = packed(200 * 2**20), tmp_path / "bomb.vtu"
    array = '<DataArray type="Float64" NumberOfComponents="3" '
    if raw:
        tail = b'<AppendedData encoding="raw">_' + bomb + b"\n</AppendedData>"
        path.write_bytes(vtu(f'{array}format="appended" offset="0"/>', appended=tail))
    else:
        head, body = base64.b64encode(bomb[:16]).decode(), base64.b64encode(bomb[16:]).decode()
        path.write_bytes(vtu(f'{array}format="binary">{head}{body}</DataArray>'))
    assert path.stat().st_size < 1_000_000
    refused(path, "takes at most 150 MB to read")


@needs_limits
def test_a_tag_of_a_node_does_not_take_all_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Gmsh's numbers of nodes may be sparse: the largest alone decided how much memory was filled."""
    monkeypatch.setattr(foreign, "MAX_MEMORY", 150_000_000)
    path = tmp_path / "sparse.msh"
    path.write_text(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
        "$Nodes\n1 3 1 40000000\n2 1 0 3\n1\n2\n40000000\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
        "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 40000000\n$EndElements\n",
        encoding="ascii",
    )
    refused(path, "takes at most 150 MB to read")
    monkeypatch.undo()
    assert len(read_section(path).triangles) == 1


ENTITIES = '<!DOCTYPE a [<!ENTITY a "aaaa">]>'


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (vtu("", before=ENTITIES), "without definitions"),
        (vtu("", before=ENTITIES).decode().encode("utf-16"), "without definitions"),
        (vtu("", header="Int32"), "header_type"),
        (vtu("<a/>" * (foreign.MAX_ELEMENTS + 1)), "elements"),
        (vtu("", appended=b"<AppendedData>_\xff\n</AppendedData>" + b"<a/>" * 9000), "binary data"),
    ],
    ids=["entities", "entities in UTF-16", "counts below zero", "elements", "elements behind the data"],
)
def test_xml_that_is_more_than_a_mesh(content: bytes, said: str, tmp_path: Path) -> None:
    path = tmp_path / "m.vtu"
    path.write_bytes(content)
    refused(path, said)


def test_the_limit_of_memory_is_taken_back(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_AS)
    path = tmp_path / "m.vtu"
    write_section(SQUARE, path)
    assert len(read_section(path).triangles) == 2
    path.write_bytes(b"no mesh")
    refused(path, "mesh file")
    assert resource.getrlimit(resource.RLIMIT_AS) == before


# -- files that lead to others -------------------------------------------------------------------------------


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """A mesh as XDMF with its HDF5 file beside it."""
    path = tmp_path / "mesh" / "m.xdmf"
    path.parent.mkdir()
    write_section(SQUARE, path)
    assert len(read_section(path).triangles) == 2
    return path


def altered(path: Path, old: str, new: str) -> Path:
    """The file with other words in it."""
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", ["../other.h5", "/{}/other.h5", "sub/../../other.h5", "link.h5", "pipe.h5"])
def test_data_from_another_folder(name: str, mesh: Path) -> None:
    elsewhere = mesh.parent.parent / "other.h5"
    (mesh.parent / "m.h5").rename(elsewhere)
    (mesh.parent / "sub").mkdir()
    (mesh.parent / "link.h5").symlink_to(elsewhere)
    os.mkfifo(mesh.parent / "pipe.h5")
    name = name.format(str(elsewhere.parent).strip("/"))
    refused(altered(mesh, "m.h5:", f"{name}:"), "beside it")


def test_binary_data_from_anywhere(mesh: Path) -> None:
    refused(altered(mesh, 'Format="HDF"', 'Format="Binary"'), "beside it")


@pytest.mark.parametrize("how", ["link", "external", "virtual"])
def test_an_hdf5_file_that_leads_to_another(how: str, mesh: Path) -> None:
    beside, elsewhere = mesh.parent / "m.h5", mesh.parent.parent / "other.h5"
    with h5py.File(beside) as file:
        name = next(iter(file))
        values = file[name][()]
    with h5py.File(elsewhere, "w") as file:
        file[name] = values
    values.tofile(elsewhere.with_suffix(".raw"))
    with h5py.File(beside, "a") as file:
        del file[name]
        if how == "link":
            file[name] = h5py.ExternalLink("../other.h5", f"/{name}")
        elif how == "external":
            raw = [(str(elsewhere.with_suffix(".raw")), 0, values.nbytes)]
            file.create_dataset(name, values.shape, values.dtype, external=raw)
        else:
            layout = h5py.VirtualLayout(values.shape, values.dtype)
            layout[...] = h5py.VirtualSource("../other.h5", name, values.shape)
            file.create_virtual_dataset(name, layout)
    refused(mesh, "links to others" if how == "link" else "holds its data itself")


def test_a_dataset_that_is_larger_than_its_file(mesh: Path) -> None:
    """A dataset that was never written takes no room in the file, and all of it in memory."""
    with h5py.File(mesh.parent / "m.h5", "a") as file:
        name = next(iter(file))
        del file[name]
        file.create_dataset(name, (2**28, 3), "f8", chunks=(2**16, 3))
    refused(mesh, "at most 1000 MB")


def test_references_that_multiply(mesh: Path) -> None:
    """Each of a few references to one array is an array of its own in memory."""
    text = mesh.read_text(encoding="utf-8")
    many = '<DataItem Reference="XML">/Xdmf/Domain</DataItem>' * 2000
    mesh.write_text(text.replace("</Grid>", f"{many}<!--{'x' * 600_000}--></Grid>"), encoding="utf-8")
    refused(mesh, "at most 1000 MB")


# -- drawings ------------------------------------------------------------------------------------------------


def test_blocks_within_blocks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten blocks, each of ten of the next, are ten to the power ten lines."""
    ezdxf = pytest.importorskip("ezdxf")
    assert drawing._MOST == 20_000
    monkeypatch.setattr(drawing, "_MOST", 2000)
    document = ezdxf.new()
    document.blocks.new("B0").add_line((0, 0), (1, 0))
    for level in range(1, 11):
        block = document.blocks.new(f"B{level}")
        for k in range(10):
            block.add_blockref(f"B{level - 1}", (k, 0))
    document.modelspace().add_blockref("B10", (0, 0))
    path = tmp_path / "bomb.dxf"
    document.saveas(path)
    with pytest.raises(InputError, match="at most 2000 curves"):
        outline_section(path, scale=1.0)


def test_a_block_that_holds_itself(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.blocks.new("B").add_blockref("B", (0, 0))
    document.modelspace().add_blockref("B", (0, 0))
    path = tmp_path / "itself.dxf"
    document.saveas(path)
    with pytest.raises(InputError, match="drawing"):
        outline_section(path, scale=1.0)
