"""The published cases: what must agree does, and what is known to differ is said."""

from __future__ import annotations

import ast
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from leblanc.cli import main
from leblanc.scene.scene import jeffcott, load_scene
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_cases, kept_group, verdicts
from validation.case import PRINTED, Claims, Origin, compare
from validation.cases.liquid import layer
from validation.cases.rotors import turning
from validation.cases.rotors.rigs import horizontal_rig, horizontal_rotor, vertical_rig, vertical_rotor
from validation.command import GROUPS, all_cases
from validation.study import data

FOLDER = Path(__file__).parents[2] / "validation" / "cases"


def test_every_group_has_cases() -> None:
    """Computed by the net, which keeps their names; a name stands for one case."""
    names = [case["name"] for case in kept_cases()]
    assert {name.partition("/")[0] for name in names} == set(GROUPS)
    assert len(set(names)) == len(names)


def test_layer_against_computed_flow() -> None:
    """Within 1 % where the flow is smooth, but for the gas's share at whirl ratio 0.5."""
    found = kept_group("layer")
    bore = {f"C_0.05_f1-{variant}" for variant in ("plain", "dispersion", "friction", "both")}
    names = {"A_f1", "A_f2", "B_0.85_f1", "B_1.3_f1", "B_1.3_f2", "C_0.05_f1-mean-rotation"}
    assert names | bore <= verdicts(found, "agrees")
    # The computed flow is no target there: it depends on its mesh.
    assert {f"{name}-late" for name in bore} <= verdicts(found, "trend")
    # The gas of the reference adds 0.001 to a force of 0.105.
    half = found["B_0.5_f1"]
    assert abs(half["printed"] - 0.001 - half["computed"]) < 0.005 * half["computed"]
    runs = {run["name"]: run for run in data("openfoam_layer.json")["cases"]}
    come_out_again([layer._steady(runs[name]) for name in ("A_f1", "A_f2")])


@kills("solvers.pypde.coupled:RotorLayersPDE.evolution_rate", "damping @ rate", "1.05 * damping @ rate")
@kills("validation.cases.liquid.layer:rotor_cases", "apart[CELLS[-1]])", "apart[CELLS[0]])")
def test_a_rotor_and_its_layer_by_py_pde_and_by_the_steps_of_run_ups(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two codes of one set of equations come together with the second order of both, as on 128 cells."""
    assert {f"rotor-{cells}-cells" for cells in layer.CELLS} <= verdicts(kept_group("layer"), "agrees")
    monkeypatch.setattr(layer, "CELLS", (8, 16, 32))
    found = {case.name.partition("/")[2]: case for case in layer.rotor_cases()}
    assert [*found] == ["rotor-8-cells", "rotor-16-cells", "rotor-32-cells", "rotor-order"]
    assert {case.verdict for case in found.values()} == {"agrees"}
    left = [float(found[f"rotor-{cells}-cells"].difference) for cells in layer.CELLS]  # type: ignore[arg-type]
    assert left[0] > 3.0 * left[1] > 9.0 * left[2] > 0.0


def test_finite_elements_agree_with_closed_forms() -> None:
    elements = [case for case in all_cases("optimal_volume") if "/fem-" in case.name]
    assert len(elements) == 9 and all(case.verdict == "agrees" for case in elements)


def test_the_solved_response_satisfies_the_vector_model() -> None:
    verdicts = {case.name: case.verdict for case in all_cases("vector_model")}
    assert verdicts["vector_model/eq-24"] == verdicts["vector_model/eq-26"] == "agrees"
    assert verdicts["vector_model/eq-25"] == "erratum"


def test_horizontal_rig_fit() -> None:
    found = {case.name.partition("/")[2]: case for case in all_cases("horizontal_rig")}
    # tan(delta) alone with the resonance held: ratio 0.085, residuals of 9, 9, 0, 18, 5, -18 deg.
    assert found["lag-alone"].computed == pytest.approx(0.0853, abs=5e-5)
    for residual in ("+9.1", "+8.9", "+0.0", "+18.2", "+5.0", "-17.8"):
        assert residual in str(found["lag-alone"].difference)
    # While the wall is wet the liquid is an added mass: with the resonance held it changes no angle.
    assert found["rotor-and-liquid"].computed == pytest.approx(found["lag-alone"].computed, rel=1e-6)


def test_vertical_rig_is_honest() -> None:
    found = {case.name.partition("/")[2]: case.verdict for case in all_cases("vertical_rig")}
    assert found["90-rad-s"] == "trend" and found["8-rad-s"] == "differs"


def test_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["validate", "vector_model", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    assert set(answer["cases"][0]) >= {
        "name", "source", "quantity", "printed", "computed", "difference", "verdict",
    }  # fmt: skip
    # What a script has of the cases is what is printed, numbers of numpy in it as well.
    found = all_cases("vector_model")
    assert json.loads(json.dumps([case.to_json() for case in found], allow_nan=False)) == answer["cases"]
    counted = replace(found[0], computed=np.int64(3), difference=np.float32(0.5))  # type: ignore[arg-type]
    assert json.loads(json.dumps(counted.to_json()))["computed"] == 3
    assert main(["validate", "vector_model"]) == 0
    assert "ERRATUM" in capsys.readouterr().out


def test_unknown_group(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(InputError):
        all_cases("magic")
    assert main(["validate", "magic"]) == 2


def test_origins() -> None:
    """What is called printed names its source; a code, a scan, a closed form their own."""
    words = "a quantity", 1.0, 1.0
    with pytest.raises(InputError, match="names no source of the references"):
        compare("group/a", "two other codes, exact_wave.json", *words, tolerance=0.1)
    assert compare("group/a", "DR18, eq. 9; DG21", *words, tolerance=0.1).origin == PRINTED
    for kind, name, wrong in (("scan", "", "name"), ("second code", "", "name"), ("hearsay", "x", "kind")):
        with pytest.raises(InputError, match=rf"origin\.{wrong}"):
            Origin(kind, name)  # type: ignore[arg-type]


def test_a_value_of_another_code_is_not_told_as_printed(capsys: pytest.CaptureFixture[str]) -> None:
    found = {case.name.partition("/")[2]: case for case in all_cases("optimal_volume")}
    for name, case in found.items():
        assert case.origin.kind == ("printed" if name.startswith("eq") else case.to_json()["origin"]["kind"])
        assert ("scikit-fem" in case.origin.name) == name.startswith("fem-")
    assert main(["validate", "turning"]) == 0
    shown = capsys.readouterr().out
    assert shown.count("    measured one of three resonances") == 3 and "    printed 5000 |" in shown


def test_a_verdict_hangs_on_what_is_computed() -> None:
    """One that is written down stands beside words alone: two statements of a source that exclude each other.

    And what is compared with a number is no number that is written down as well.
    """
    found = 0
    for path in sorted(FOLDER.rglob("*.py")):
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(call, ast.Call) and ast.unparse(call.func).rpartition(".")[2] == "case"):
                continue
            given = {word.arg: word.value for word in call.keywords}
            given |= dict(zip(("entry", "computed", "agrees"), call.args, strict=False))
            found += 1
            if "computed" in given:
                assert any(isinstance(node, ast.Name) for node in ast.walk(given["computed"]))
            assert "effect" in given or not isinstance(given.get("agrees"), ast.Constant), ast.unparse(call)
            assert not isinstance(given.get("verdict"), ast.Constant), ast.unparse(call)
    assert found > 50
    tables = {
        file.stem: Claims(file.stem).entries for file in sorted((FOLDER.parent / "data/cases").iterdir())
    }
    written = [(f"{group}/{name}", row) for group, rows in tables.items() for name, row in rows.items()]
    written = [(name, row) for name, row in written if "verdict" in row]
    assert {name for name, row in written if "computed" in row} == {
        *("blood_pump/eq-39-order", "blood_pump/numbering", "horizontal_rig/gravity", "spindle/discussion"),
        *("turning/modulation", "turning/amplitude"),
    }
    # Of these lists of coefficients those are made cases of that are not the printed ones.
    assert [name for name, row in written if "computed" not in row] == ["errata/dr-a", "errata/dr-equation"]


def test_a_value_half_as_large_again_does_not_agree() -> None:
    for printed, wrong in ((2.0, 3.0), (-2.0, -3.0), (2.0, -2.0), (2.0, 4.0 / 3.0)):
        words = "group/a", "DR18", "a quantity"
        widest = float(np.nextafter(1.0 / 3.0, 0.0))
        assert compare(*words, printed, printed, tolerance=widest).verdict == "agrees"
        assert compare(*words, printed, wrong, tolerance=widest).verdict == "differs"
    for tolerance in (1.0 / 3.0, 1.0, -0.1, math.nan):
        with pytest.raises(InputError, match="tolerance"):
            compare("group/a", "DR18", "a quantity", 1.0, 1.0, tolerance=tolerance)


@kills("validation.cases.rotors.turning:single_mode_damping", "2.0 * ratio *", "2.0 *")
@kills("validation.cases.rotors.turning:single_mode_damping", "1.0 - ratio**2", "1.0 - ratio")
def test_damping_of_a_single_mode() -> None:
    """That of a rotor whose answer to an unbalance beside its resonance has that share of the one at it."""
    rotor = Jeffcott(mass=2.0, stiffness=2.0 * 135.0**2, damping=2.0 * 2.0 * 0.05 * 135.0, unbalance=1.0)
    at, off = np.abs(response(rotor, [], [135.0, 143.0]).deflection)
    assert turning.single_mode_damping(135.0, 143.0, off / at) == pytest.approx(0.05, rel=1e-12)


def test_resonances_that_are_not_told_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    """With amplitudes between them nearly as large as at them, the widths are beyond the distances."""

    def found() -> list[str]:
        return [case.verdict for case in turning.cases() if "resonance" in case.name]

    assert found() == ["agrees"] * 3
    monkeypatch.setattr(turning, "_BETWEEN", {143.0: 0.0125, 160.0: 0.0165})
    assert found() == ["differs"] * 3


def test_the_rigs_are_those_of_the_examples() -> None:
    """One rig, one set of assumptions: the cases and the scenes that users run describe the same machine."""
    upright = load_scene("examples/vertical_rig.toml")
    assert upright.fills == vertical_rig()
    for name in ("mass", "stiffness", "damping", "unbalance"):
        assert getattr(jeffcott(upright), name) == pytest.approx(getattr(vertical_rotor(), name), rel=1e-9)
    lying = load_scene("examples/horizontal_rig.toml")
    assert lying.fills == horizontal_rig()
    ours = horizontal_rotor(0.1, 1000.0 * 2.0 * math.pi / 60.0)
    assert jeffcott(lying).mass == ours.mass
    assert jeffcott(lying).unbalance == pytest.approx(ours.unbalance)
    # The scene gives the dry critical speed with four digits.
    assert jeffcott(lying).stiffness == pytest.approx(ours.stiffness, rel=2e-3)
