"""Unknown values of a scene from what was measured on the machine, each with its uncertainty."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import FILE, SCENE, Option, Reader, ask

if TYPE_CHECKING:
    from leblanc.studies.fit.answer import FitAnswer

FILES = ("fit.nc",)
_COLUMNS = Reader("leblanc.studies.fit.measured:named_columns", many=True)


def fit(
    scene: Annotated[Any, SCENE, "Scene, or its file (TOML)."],
    measured: Annotated[
        str | PathLike[str],
        FILE,
        Option(argument=True),
        "Table of what was measured (CSV), headed like: speed [rpm], amplitude [mm].",
    ],
    unknown: Annotated[
        Sequence[str],
        "Path of an unknown, as in rotor.mass, whose value in the scene is the first guess; A=B ties B to A; "
        "once for each of them.",
    ],
    *,
    starts: Annotated[int, "Searches at least; more follow until the best values are found again."] = 2,
    seed: Annotated[int, "Random seed of the values that they start from."] = 0,
    scale: Annotated[
        str, "given; free: the unit of the sensor is not known, shapes count; each: of every quantity."
    ] = "given",
    noise: Annotated[
        str, 'estimate, a share of each reading ("3 %") or an error ("0.1 mm", "2 deg").'
    ] = "estimate",
    column: Annotated[
        Mapping[str, str] | Sequence[str] | None,
        _COLUMNS,
        'Column of the file that is meant: amplitude="Schwingweg [um pp]", speed=, time=.',
    ] = None,
) -> FitAnswer:
    """Unknowns of a scene from a measured curve, each with its uncertainty.

    The table is over speed, time or liquid added; commas, semicolons or tabs stand between its columns.
    Columns are named by a mapping, as in {"amplitude": "Schwingweg [um pp]"}.

    Raises
    ------
    SceneError, InputError : as for `run`; a table that cannot be read, an unknown that is no number above 0

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import leblanc as lb
    >>> rig = lb.example("horizontal_rig").replace({"speeds.count": 12})
    >>> found = lb.run(rig)
    >>> lines = [f"{s}, {a}" for s, a in zip(found.speed, found.amplitude)]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = Path(folder) / "measured.csv"
    ...     _ = table.write_text("\\n".join(["speed [rad/s], amplitude [m]", *lines]))
    ...     answer = lb.fit(rig.replace({"rotor.mass": 4.4}), table, ["rotor.mass"], starts=1)
    >>> round(answer.parameters["rotor.mass"]["value"], 3)
    4.0
    """
    return ask(fit, "leblanc.studies.fit.study:answer_fit", locals())
