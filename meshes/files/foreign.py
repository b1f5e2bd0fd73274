"""Files of strangers: what is looked at before a library reads them, and how much memory that may take.

A mesh file names what it holds, and libraries believe it: a few megabytes can unpack to as many gigabytes,
and a file can name others anywhere.
"""

from __future__ import annotations

import errno
import os
import stat
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO
from xml.etree import ElementTree
from xml.parsers import expat

from meshes.errors import InputError

MAX_BYTES = 100_000_000  # of a file
MAX_MEMORY = 1_000_000_000  # bytes that reading it may take
MAX_ELEMENTS = 5_000  # of XML
# The time of reading grows with bytes times arrays: meshio looks at all that follows for each of them.
_MOST_WORK = 5e10
_LONGEST_END = 10_000  # bytes behind binary data

_limit = threading.Lock()  # the limit of memory is one for the whole process


def open_regular(path: str | os.PathLike[str]) -> BinaryIO:
    """A file opened for reading.

    An `OSError` for a folder, a pipe, a socket or a device, which may never end.
    """
    _require_regular(Path(path).stat().st_mode, path)  # first: opening a pipe or a device may have effects
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        _require_regular(os.fstat(handle).st_mode, path)
        return os.fdopen(handle, "rb")
    except BaseException:
        os.close(handle)
        raise


def _require_regular(mode: int, path: str | os.PathLike[str]) -> None:
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "Not a regular file", str(path))


def require_file(path: str | Path, what: str = "file") -> None:
    """Refuse a file that is not there, is no regular file or is too long."""
    try:
        with open_regular(path) as file:
            size = os.fstat(file.fileno()).st_size
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError("path", str(path), f"an existing {what} that can be read ({reason})") from error
    if size > MAX_BYTES:
        raise InputError("path", str(path), f"a file of at most {MAX_BYTES // 10**6} MB")


def require_harmless_xml(path: str | Path) -> None:
    """Refuse XML that defines entities, has too many parts, or points to files that are not beside it."""
    size = Path(path).stat().st_size
    most = int(min(MAX_ELEMENTS, _MOST_WORK / max(size, 1)))
    whole = _scan(path, most)
    if Path(path).suffix.lower() == ".xdmf":
        if not whole:
            raise InputError("path", str(path), "XML that is well formed")
        _require_own_data(path, ElementTree.parse(path).getroot(), size)
    elif not whole:
        raw = Path(path).read_bytes()
        # Behind raw binary data nothing but the last closing tags may stand.
        if len(raw) - raw.find(b"</AppendedData>") > _LONGEST_END and b"</AppendedData>" in raw:
            raise InputError("path", str(path), "XML that ends behind its binary data")


def _scan(path: str | Path, most: int) -> bool:
    """Look at all elements; whether the XML is whole, which that with raw binary data within is not."""

    def refuse(allowed: str) -> None:
        raise InputError("path", str(path), allowed)

    seen = 0

    def element(_: str, attributes: dict[str, str]) -> None:
        nonlocal seen
        seen += 1
        if seen > most:
            refuse(f"XML of at most {most} elements, at its length")
        if not attributes.get("header_type", "UInt32").startswith("UInt"):
            refuse("a file whose header_type is UInt32 or UInt64")

    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = lambda *_: refuse("XML without definitions of its own")
    parser.StartElementHandler = element
    with Path(path).open("rb") as file:
        try:
            parser.ParseFile(file)
        except expat.ExpatError:
            return False
    return True


def _require_own_data(path: str | Path, root: Any, size: int) -> None:
    """The data of an XDMF file stand in it or in HDF5 files beside it."""
    total, references = float(size), 0
    for item in root.iter():
        kind, text = item.get("Format"), (item.text or "").strip()
        references += "Reference" in item.attrib
        if kind == "HDF":
            total += _hdf_bytes(path, text)
        elif kind not in (None, "XML"):
            raise InputError("path", str(path), "an XDMF file with its data in it or in an .h5 beside it")
        elif item.tag == "Information" and "<!" in text:
            raise InputError("path", str(path), "XML without definitions of its own")
        if total * (1 + references) > MAX_MEMORY:
            raise InputError("path", str(path), f"a mesh of at most {MAX_MEMORY // 10**6} MB")


def _hdf_bytes(path: str | Path, text: str) -> int:
    """Bytes of a dataset of an HDF5 file beside an XDMF file, which stands in that file itself."""
    import h5py

    def fault(allowed: str) -> InputError:
        return InputError("path", str(path), f"{allowed}; it names {text[:60]!r}")

    name, _, inside = text.partition(":")
    file = Path(path).resolve().parent / name
    if Path(name).name != name or not inside or not stat.S_ISREG(_mode(file)):
        raise fault("an XDMF file with its data in it or in an .h5 beside it")
    require_file(file)
    try:
        with h5py.File(file, "r") as found:
            for key in inside.strip("/").split("/"):
                if not isinstance(found.get(key, getlink=True), h5py.HardLink):
                    raise fault("an .h5 file without links to others")
                found = found[key]
            if not isinstance(found, h5py.Dataset) or found.external or found.is_virtual:
                raise fault("an .h5 file that holds its data itself")
            return int(found.nbytes)
    except (OSError, RuntimeError, KeyError, AttributeError) as error:
        raise fault(f"an .h5 file that can be read ({error})") from error


def _mode(path: Path) -> int:
    """Kind of a file as such, not of what a link leads to; 0 without one."""
    try:
        return os.lstat(path).st_mode
    except (OSError, ValueError):
        return 0


@contextmanager
def limited_memory(path: str | Path) -> Iterator[None]:
    """Let a library that reads a file take no more than `MAX_MEMORY`, where the system can limit it."""
    try:
        import resource

        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[0])
    except (ImportError, OSError):
        yield
        return
    with _limit:
        soft, hard = resource.getrlimit(resource.RLIMIT_AS)
        wanted = pages * resource.getpagesize() + MAX_MEMORY
        if soft != resource.RLIM_INFINITY:
            wanted = min(wanted, soft)
        resource.setrlimit(resource.RLIMIT_AS, (wanted, hard))
        try:
            yield
        except MemoryError as error:
            allowed = f"a mesh that takes at most {MAX_MEMORY // 10**6} MB to read"
            raise InputError("path", str(path), allowed) from error
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
