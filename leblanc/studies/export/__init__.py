"""The machine's answers in the files of other tools: tables, workbook, FMU for co-simulation, state space."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Annotated

from leblanc.core.question import SCENE, Option, Quantity, ask
from leblanc.core.units import ANGULAR_SPEED

if TYPE_CHECKING:
    from leblanc.scene.scene import SceneOrPath
    from leblanc.studies.export.answer import ExportAnswer

# Of each kind some; the others are named after the scene and after what it has.
FILES = ("response.csv", "runup.csv", "machine.mat", "machine.json")


def export(
    scene: Annotated[SceneOrPath, SCENE, "The machine, or the path of its file."],
    *,
    to: Annotated[
        str,
        Option(apart=True),
        "csv or xlsx: tables; fmu: the run-up for co-simulation; statespace: linear matrices, MAT and JSON.",
    ],
    speed: Annotated[
        Quantity | None, ANGULAR_SPEED, "Spin speed of the state space [default: the machine's last]."
    ] = None,
    decimal: Annotated[str, "point, or comma with semicolons between the columns (csv)."] = "point",
    out: str | PathLike[str] | None = None,
) -> ExportAnswer:
    """Tables, workbook, FMU or state space of a machine, for other tools.

    Tables have the answers of `run` and, with a run-up or a programme, of `run_up`; SI units. The curves over
    speed have one grid with the peaks. `out` is a folder [default: out/<scene name>].

    Raises
    ------
    SceneError : with everything that is wrong with the file
    InputError : a format that is none, what the format does not serve, an extra that is not installed

    Examples
    --------
    >>> import leblanc as lb
    >>> from tempfile import TemporaryDirectory
    >>> machine = lb.example("centrifuge").replace({"model.friction": "none"})
    >>> with TemporaryDirectory() as folder:
    ...     lb.export(machine, to="statespace", out=folder).files
    ('chamber_1.json', 'chamber_1.mat', 'machine.json', 'machine.mat')
    """
    return ask(export, "leblanc.studies.export.study:answer", locals())
