"""Tables of measured values as loggers write them: read in SI and zero to peak, or refused with the line."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.studies.fit.measured import named_columns, read_measured
from leblanc.studies.fit.noise import parse_noise
from leblanc.studies.fit.notes import FitCode
from meshes.errors import InputError
from tests.mutants import kills


def table(folder: Path, text: str | bytes) -> Path:
    (folder / "m.csv").write_bytes(text.encode() if isinstance(text, str) else text)
    return folder / "m.csv"


def test_tables(tmp_path: Path) -> None:
    """Units of the header, any order of columns and rows, comments."""
    text = "# a run\namplitude [um], speed (rpm), liquid_angle [deg]\n2, 300, 90\n1, 60, -45\n"
    found = read_measured(table(tmp_path, text), ("x", "y"))
    np.testing.assert_allclose(found.at, [2 * math.pi, 10 * math.pi])
    assert [name for name, _ in found.columns] == ["amplitude", "liquid_angle"]
    np.testing.assert_allclose(found.columns[0][1], [1e-6, 2e-6])
    np.testing.assert_allclose(found.columns[1][1], [-math.pi / 4, math.pi / 2])
    free = read_measured(table(tmp_path, "speed [rpm], amplitude [LSB]\n60, 5\n120, 7\n"), (), True)
    np.testing.assert_allclose(free.columns[0][1], [5.0, 7.0])
    # Of a free scale what the file has is kept.
    free = read_measured(table(tmp_path, "speed [rpm], amplitude [mm pp]\n60, 5\n120, 7\n"), (), True)
    np.testing.assert_allclose(free.columns[0][1], [5.0, 7.0])


@pytest.mark.parametrize(
    "text",
    [
        "speed [rpm]; amplitude [mm]\n60; 1.5\n1200; 2.25\n",
        "speed [rpm];amplitude [mm]\n60;1,5\n1.200,0;2,25\n",
        "speed [rpm]\tamplitude [mm]\n60\t1,5\n1200\t2,25\n",
        '"speed [rpm]", "amplitude [mm]"\n60, 1.5\n1200, 2.25\n',
        '"speed [rpm]","amplitude [mm]"\r\n"60","1.5"\r\n"1200","2.25"\r\n',
        '"speed, rpm","amplitude, mm"\n60,1.5\n"1200",2.25\n',
        "speed, rpm; amplitude, mm\n60; 1.5\n1200; 2.25\n",
        "Speed (rpm),Amplitude (mm)\n60,1.5\n1200,2.25\n",
        "speed;amplitude\nrpm;mm\n60;1,5\n1200;2,25\n",
        "sep=;\nspeed [rpm];amplitude [mm]\n60;1.5\n1200;2.25\n",
        "speed [rpm],amplitude [mm],\n60,1.5,\n\n1200,2.25,\n",
        "\ufeffspeed [rpm],amplitude [mm]\n60,1.5\n1200,2.25\n",
        "speed [rpm],amplitude [mm]\n60,1.5\n1200,2.25\n".encode("utf-16"),
        "# Prüfstand\nspeed [rpm],amplitude [mm]\n60,1.5\n1200,2.25\n".encode("cp1252"),
    ],
)
def test_tables_as_loggers_write_them(tmp_path: Path, text: str | bytes) -> None:
    """Semicolons and decimal commas, tabs, quotes, units in brackets, after a comma, in a row."""
    found = read_measured(table(tmp_path, text), ("x", "y"))
    np.testing.assert_allclose(found.at, [2 * math.pi, 40 * math.pi])
    ((name, values),) = found.columns
    assert name == "amplitude"
    np.testing.assert_allclose(values, [1.5e-3, 2.25e-3])


@kills("leblanc.studies.fit.measured:_column", "size * factor, order", "size / factor, order")
@kills("leblanc.studies.fit.measured:read_measured", "at**each.order if", "at**-each.order if")
def test_motions_become_displacements() -> None:
    """One motion of 0.2 mm at 50 and 100 rad/s, as a displacement, velocity, acceleration and by its rms."""
    import tempfile

    size, speed = 2e-4, np.array([50.0, 100.0])
    root = math.sqrt(2.0)
    written = {
        "amplitude [mm]": np.full(2, 0.2),
        "displacement 0-pk [mm]": np.full(2, 0.2),
        "displacement peak-to-peak (um)": np.full(2, 400.0),
        "amplitude [um pp]": np.full(2, 400.0),
        "vibration rms [um]": np.full(2, 200.0 / root),
        "velocity [mm/s]": 1e3 * size * speed,
        "amplitude [mm/s rms]": 1e3 * size * speed / root,
        "acceleration [m/s^2]": size * speed**2,
        "acceleration [g pp]": 2.0 * size * speed**2 / 9.80665,
        "acceleration rms [mg]": 1e3 * size * speed**2 / 9.80665 / root,
    }
    with tempfile.TemporaryDirectory() as folder:
        for header, values in written.items():
            rows = "".join(f"{at};{value!r}\n" for at, value in zip(speed, values.tolist(), strict=True))
            found = read_measured(table(Path(folder), f"speed [rad/s];{header}\n{rows}"), ("x",))
            np.testing.assert_allclose(found.columns[0][1], size, rtol=1e-12, err_msg=header)
            plain = header in ("amplitude [mm]", "displacement 0-pk [mm]")
            assert [note.code for note in found.notes] == ([] if plain else [FitCode.CONVERTED])


def test_columns_in_other_words(tmp_path: Path) -> None:
    """`--column` names what is meant, gives it a unit that it lacks, and leaves out other columns."""
    text = "Nr;Drehzahl;Schwingweg [um pp];Temp [C]\n1;60;3000;20\n2;120;4000;21\n"
    asked = named_columns(['amplitude="Schwingweg [um pp]"', "speed = Drehzahl [rpm]"])
    found = read_measured(table(tmp_path, text), ("x",), column=asked)
    np.testing.assert_allclose(found.at, [2 * math.pi, 4 * math.pi])
    np.testing.assert_allclose(found.columns[0][1], [1.5e-3, 2e-3])
    for wrong in (
        ["amplitude=Schwingweg [mm]"],
        ["amplitude=Weg"],
        ["weight=Nr"],
        ["speed=Nr", "amplitude=Nr"],
    ):
        with pytest.raises(InputError):
            read_measured(table(tmp_path, text), ("x",), column=named_columns(wrong))
    for wrong in (["amplitude"], ["=Nr"], ["speed=Nr", "speed=Temp"]):
        with pytest.raises(InputError):
            named_columns(wrong)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "a header"),
        ("speed [rpm], amplitude [kg]\n1, 2\n3, 4\n", "length"),
        ("speed [rpm], amplitde [mm]\n1, 2\n3, 4\n", "one of"),
        ("speed [rpm], time [s], amplitude [mm]\n1, 2, 3\n3, 4, 5\n", "speed, time or added"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3, x\n", "m.csv:3"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3\n", "2 finite numbers"),
        ("speed [rpm], amplitude [mm]\n0, 2\n3, 4\n", "above 0"),
        ("added [ml], peak [mm]\n-1, 2\n3, 4\n", "at least 0"),
        ("speed [rpm], amplitude [mm], amplitude [um]\n1, 2, 3\n3, 4, 5\n", "one column of amplitude"),
        ("speed [rpm], amplitude [mm], displacement [um]\n1, 2, 3\n3, 4, 5\n", "one column of amplitude"),
        ("speed [rpm], speed [rpm], amplitude [um]\n1, 2, 3\n3, 4, 5\n", "m.csv:1"),
        ("speed [rpm], amplitude [mm]\n1, 2\n\n3, -4\n", "m.csv:4"),
        ("speed [rpm], velocity [mm/s]\n1, 2\n3, -4\n", "m.csv:3"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3, -4\n", "at least 0"),
        ('speed [rpm], amplitude [mm]\n1, 2\n3, "4\n5, 6\n', "m.csv:3"),
        ('"speed [rpm], amplitude [mm]\n1, 2\n3, 4\n', "m.csv:1"),
        ("speed [rpm], amplitude [mm]\n1, 2\n1e300, 4\n", "m.csv:3"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3, 1e300\n", "m.csv:3"),
        ("speed [rpm]; amplitude [mm]\n1; 2.5\n3; 2,5\n", "decimal sign"),
        ('speed [rpm], amplitude [um]\n600, 2\n"1,200", 3\n', "thousands"),
        ("speed [rpm], amplitude [mm]\n1, 2,5\n3, 2,5\n", "semicolons or tabs"),
        ("time [s], acceleration [g]\n1, 2\n3, 4\n", "displacement over time"),
        ("speed [rpm], phase pp [deg]\n1, 2\n3, 4\n", "plain value"),
    ],
)
def test_faulty_tables(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError) as fault:
        read_measured(table(tmp_path, text), ("x", "y"))
    assert words in str(fault.value) and "\n" not in str(fault.value)


_TOKENS = st.sampled_from(
    [
        "speed",
        "amplitude",
        "time",
        " [rpm]",
        " [mm]",
        "pp",
        ",",
        ";",
        "\t",
        '"',
        "\n",
        "1",
        "2,5",
        "-3.5",
        "e9",
    ]
)


@settings(max_examples=60)
@given(st.text(max_size=200) | st.lists(_TOKENS, max_size=40).map("".join))
def test_any_text_is_refused_or_read(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    path = table(tmp_path_factory.getbasetemp(), text.encode("utf-8", "surrogatepass"))
    try:
        found = read_measured(path, ("x",))
        assert (np.diff(found.at) >= 0.0).all() and np.isfinite(found.at).all()
    except InputError:
        return


def test_noise_in_words() -> None:
    """A share of each reading, or an error with a unit; nothing else."""
    assert parse_noise("estimate")[0] == "estimate"
    known = {"3 %": ("relative", 0.03), "3%": ("relative", 0.03), "0.1 mm": ("length", 1e-4)}
    for text, (kind, size) in (known | {"2 deg": ("angle", math.pi / 90.0)}).items():
        assert parse_noise(text)[0] == kind
        assert parse_noise(text)[1] == pytest.approx(size, rel=1e-12)
    for wrong in ("", "3 kg", "0 mm", "-1 mm", "0 %", "100 %", "nan mm", "much"):
        with pytest.raises(InputError):
            parse_noise(wrong)
