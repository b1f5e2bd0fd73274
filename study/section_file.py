"""Section of a chamber from any file: a mesh, or an outline that is meshed here."""

from __future__ import annotations

from pathlib import Path

from meshes.border import InputError
from meshes.section import Section

OUTLINES = ".dxf, .step, .stp, .iges, .igs or .brep"


def is_outline(path: str | Path) -> bool:
    """Whether a file is a drawing or a model by its ending.

    Parameters
    ----------
    path : of the file
    """
    from meshes.outline import SUFFIXES

    return Path(path).suffix.lower() in SUFFIXES


def section_of_any_file(
    path: str | Path, unit: float | None, size: float | None, names: tuple[str, str]
) -> Section:
    """Section from a mesh file or from an outline, about the file's origin.

    Parameters
    ----------
    path : of the file
    unit : its unit of length, m; None for the one that it names, of a mesh for 1 m
    size : of the cells at walls of an outline, m; None for a hundredth of its largest extent
    names : what the user calls unit and size

    Returns
    -------
    The section; that of an outline has quadratic cells.

    Raises
    ------
    InputError : a file that cannot be used, a size for a mesh file, which has its cells, a unit that is
        missing, or given where the file names it, a library of the extra `cad` that is missing
    """
    if not is_outline(path):
        if size is not None:
            raise InputError(names[1], size, "left out for a mesh file, which has its cells")
        from meshes.exchange import read_section

        return read_section(path, 1.0 if unit is None else unit)
    from meshes.outline import outline_section

    try:
        return outline_section(path, size, scale=unit)
    except ImportError as missing:
        allowed = f"a mesh file; outlines need the extra `cad`: pip install leblanc[cad] ({missing})"
        raise InputError("path", str(path), allowed) from missing
    except InputError as fault:
        if fault.field == "height":
            allowed = "a plane outline; meshes.outline.outline_section cuts a solid at a height"
            raise InputError("path", str(path), allowed) from fault
        field = dict(zip(("scale", "wall_size"), names, strict=True)).get(fault.field, fault.field)
        raise InputError(field, fault.value, fault.allowed) from fault
