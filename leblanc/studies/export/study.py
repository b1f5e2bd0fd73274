"""A machine written for other tools."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from leblanc.core.files import chosen_dir, out_dir, safe_name
from leblanc.core.notes import Note, NoteCode
from leblanc.core.progress import update
from leblanc.scene.scene import Scene
from leblanc.studies.export.answer import ExportAnswer
from meshes.errors import InputError

FORMATS = ("csv", "xlsx", "fmu", "statespace")
_DECIMALS = ("point", "comma")


class ExportCode(NoteCode):
    """What a user of exported files should know."""

    OTHER_END = "fmu_other_end"


def answer(
    scene: Scene, to: str, speed: float | None, decimal: str, out: str | PathLike[str] | None
) -> ExportAnswer:
    """Write the files of a format into a folder."""
    _require(to, speed, decimal)
    folder = out_dir(scene.name, chosen_dir(scene.name, None if out is None else Path(out)))
    notes: tuple[Note, ...] = ()
    update(what=f"export to {to}")
    if to == "statespace":
        from leblanc.studies.export.space import spaces, write_spaces

        found, notes = spaces(scene, speed)
        made = write_spaces(found, notes, folder)
    elif to == "fmu":
        from leblanc.studies.export.fmu import write_fmu

        name = f"{safe_name(scene.name)}.fmu"
        model = write_fmu(scene, folder / name)
        made = {name: f"FMI 2.0 for co-simulation: the run-up, liquid model {model}"}
        text = "At the other end leblanc must be installed, in the Python that the tool loads."
        notes = (Note(ExportCode.OTHER_END, {}, text),)
    else:
        from leblanc.studies.export.tables import tables, write_csv, write_xlsx

        if to == "csv":
            each = tables(scene)
            write_csv(each, folder, decimal)
            made = {f"{table.name}.csv": table.text for table in each}
        else:
            from leblanc.studies.export.tables import extra

            extra("xlsxwriter", to)  # better now than after the work
            each, name = tables(scene), f"{safe_name(scene.name)}.xlsx"
            write_xlsx(each, folder / name)
            made = {name: f"sheets {', '.join(table.name for table in each)}"}
    return ExportAnswer(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        to=to,
        folder=str(folder),
        files=tuple(made),
        contents=tuple(made.values()),
        notes=notes,
    )


def _require(to: str, speed: float | None, decimal: str) -> None:
    if to not in FORMATS:
        raise InputError("to", to, f"one of {', '.join(FORMATS)}")
    if decimal not in _DECIMALS:
        raise InputError("decimal", decimal, " or ".join(_DECIMALS))
    if decimal == "comma" and to != "csv":
        raise InputError(
            "decimal",
            decimal,
            f"left out for {to}: cells are numbers" if to == "xlsx" else f"left out for {to}",
        )
    if speed is not None and to != "statespace":
        raise InputError("speed", speed, f"left out for {to}")
