import json
import math
import re
from functools import cache

import numpy as np
import pytest

from meshes.errors import InputError
from tests.mutants import kills
from validation.case import Case, Effect, compare, shape_verdict
from validation.cases.errata import formulas
from validation.cases.errata.tub import tub_matrices
from validation.cases.rotors.rigs import horizontal_rig
from validation.command import all_cases


@cache
def by_name() -> dict[str, Case]:
    cases = all_cases("errata")
    assert len({case.name for case in cases}) == len(cases)
    return {case.name: case for case in cases}


def test_each_erratum_is_wrong_by_computation() -> None:
    for case in by_name().values():
        assert case.verdict == "erratum"
        assert case.group == "errata"
        assert case.printed != case.computed


def test_records_are_json() -> None:
    records = json.loads(json.dumps([case.to_json() for case in by_name().values()], allow_nan=False))
    assert {"name", "source", "quantity", "printed", "computed", "difference", "verdict"} <= set(records[0])


@pytest.mark.parametrize(
    ("name", "printed", "computed"),
    [
        # The polar moment of a disc: s^4/32 + s^2/4 d^2, with d = s/2 at the rim and d -> 0 at the axis.
        ("errata/dr-eq-18-moment", 3 / 32, 1 / 32),
        ("errata/dr-gyroscopic-alpha", -2.0, -1.0),
        ("errata/dr-gyroscopic-gamma", 2.0, 1.0),
        ("errata/dr-y-equation-first-derivative", 1.0, 0.0),
        ("errata/dr-y-equation-second-derivative", 0.0, 1.0),
        # m e/(m_1 + m_2)
        ("errata/dg-section-4-far", 3.7e-3, 1800e-6 / 60.7),
        ("errata/dr-oblate", None, math.sqrt(3.0)),
        ("errata/ff-eq-10", 4.0, 2.0),
        ("errata/dr-eq-4-y-beta", -1.0, 0.0),
        ("errata/dr-eq-4-beta-gamma", 0.0, -1.0),
        ("errata/dr-eq-4-alpha-gamma", 0.0, -1.0),
        ("errata/dr-eq-14-x5", 5.0, 1.0),
        ("errata/dr-eq-16-x5", 5.0, 1.0),
        # 33 Hz over nine times the cage's share, (1 - 0.2305)/2.
        ("errata/dr-table-bpfo", 9.55, 85.77 / 9.0),
        ("errata/dr-fig-20", None, 1.0 / math.sqrt(1.0 - 2.0 * 0.2**2)),
        # (m_2/2) (e omega)^2
        ("errata/dr-eq-4-unbalance", 1.0, 0.5),
        ("errata/dr-eq-4-gyroscopic", 2.0, 1.0),
        # 30 deg + arcsin(1/4)
        ("errata/dr-alpha-range", None, 30.0 + math.degrees(math.asin(0.25))),
        ("errata/dr-beta", 998.2 * 4050.0, 4050.0 / 9.81),
        # sqrt(k11/M), sqrt(k33/(A - C))
        ("errata/ff-eq-37", math.sqrt(50.0 / 0.4), math.sqrt(2000.0)),
        # c_w eta pi l^3 sqrt(m/c_m)/I_x, and with (r/l)^2.
        ("errata/dr-pump-drag-table", 1.48e-7, 3.554540e-3),
        ("errata/dr-pump-drag-eq-41", 1.48e-7, 4.468145e-4),
    ],
)
def test_values(name: str, printed: float | None, computed: float) -> None:
    case = by_name()[name]
    if printed is not None:
        assert case.printed == pytest.approx(printed, rel=1e-6)
    # The two limits (a thin shift, a high speed) are reached within 1e-5.
    assert case.computed == pytest.approx(computed, rel=1e-5, abs=1e-12)


def test_terms_of_the_tub_are_symmetric() -> None:
    """Each of the five terms is the one that the spring's energy gives; four stand right elsewhere."""
    found = {name: case.computed for name, case in by_name().items() if "-equation-" in name}
    assert found["errata/dr-alpha-equation-stiffness"] == "-c_y x z"  # a_46 of the list below eq. 8
    assert found["errata/dr-alpha-equation-damping"] == "-h_y x z"
    assert found["errata/dr-beta-equation-damping"] == "-h_z x"  # a_35
    assert found["errata/dr-gamma-equation-damping"] == "-h_x y z"  # a_56
    assert found["errata/dr-gamma-equation-rate"] == "c_x y^2 + c_y x^2"  # a_66


def test_statements_are_refuted_by_the_sources_own_equations() -> None:
    found = by_name()
    # Undamped: (K - M w^2)/(K - (M + m_f) w^2) at half the wet critical speed; damping hardly counts.
    full = sum(fill.full_mass for fill in horizontal_rig())
    expected = (1.0 - 0.25 * 4.0 / (4.0 + full)) / 0.75
    assert found["errata/dr-any-speed"].computed == pytest.approx(expected, rel=0.01)
    assert found["errata/dg-forces"].computed == "Q_x and Q_z"
    assert found["errata/dr-third-group"].computed == "i <= 3 < j: 6 of them, and 0 with i, j <= 3"


def test_eq_13_names_another_moment() -> None:
    case = by_name()["errata/dr-eq-13"]
    assert (case.printed, case.computed) == ("E", "D")


def test_weak_supports_move_the_region_of_balls() -> None:
    """The conditions say 49.5 rad/s whatever the damping; eigenvalues that much with 40 N s/m alone."""
    case = by_name()["errata/ff-conclusion-2"]
    assert case.printed == pytest.approx(49.512, rel=1e-4)
    assert case.computed == pytest.approx(79.24, abs=0.05)
    assert "it is 49.4" in case.note


def test_eq_18_is_litres_off() -> None:
    case = by_name()["errata/dr-eq-18"]
    assert case.printed == pytest.approx(2.040, rel=1e-3)
    assert case.computed == pytest.approx(54.43957239e-6, rel=1e-8)
    assert "56.7 ml" in case.note


def test_eq_20_prints_a_negative_volume() -> None:
    case = by_name()["errata/dr-eq-20"]
    assert isinstance(case.printed, float)
    assert isinstance(case.computed, float)
    assert case.printed < 0.0 < case.computed


def test_eq_25_loses_the_ratio() -> None:
    case = by_name()["errata/dr-eq-25"]
    assert isinstance(case.printed, float)
    assert isinstance(case.computed, float)
    # cos(alpha) as printed is k times what it should be.
    assert math.cos(case.printed) == pytest.approx(0.8 * math.cos(case.computed), rel=1e-12)


def test_stiffness_entries_are_exchanged() -> None:
    a24, a25 = by_name()["errata/dr-a24"], by_name()["errata/dr-a25"]
    assert (a24.printed, a24.computed) == ("0", "-c_y z")
    assert (a25.printed, a25.computed) == ("-c_y z", "0")
    assert "19 of 21" in a24.note


@kills(
    "validation.cases.errata.tub:tub_matrices",
    "sp.Matrix(q[:3]) + turn * place - place",
    "sp.Matrix(q[:3]) - turn * place + place",
)
def test_tub_matrices_against_rigid_body_kinematics() -> None:
    """Mass and stiffness are J^T J with J of a rigid body's small displacement; the spin does no work."""
    matrices = tub_matrices()
    x, y, z = 0.3, -0.2, 0.5
    jacobian = np.array([[1, 0, 0, 0, z, -y], [0, 1, 0, -z, 0, x], [0, 0, 1, y, -x, 0]])
    numbers = {"x": x, "y": y, "z": z, "c_x": 2.0, "c_y": 3.0, "c_z": 5.0}
    stiffness = np.array(matrices.stiffness.subs(numbers), dtype=float)
    np.testing.assert_allclose(stiffness, jacobian.T @ np.diag([2.0, 3.0, 5.0]) @ jacobian, atol=1e-15)
    numbers = {"x_D": x, "y_D": y, "z_D": z, "m_2": 7.0, "J_a": 0.4, "J_b": 0.9}
    mass = np.array(matrices.mass.subs(numbers), dtype=float)
    inertia = np.diag([0, 0, 0, 0.4, 0.9, 0.4])
    np.testing.assert_allclose(mass, 7.0 * jacobian.T @ jacobian + inertia, atol=1e-14)
    gyroscopic = np.array(matrices.gyroscopic.subs({"J_b": 0.9, "omega": 10.0}), dtype=float)
    np.testing.assert_array_equal(gyroscopic, -gyroscopic.T)


@kills("validation.cases.errata.tub:tub_matrices", "spin[0, 2] + omega", "spin[0, 2] + 2 * omega")
def test_gyroscopic_coupling_is_the_torque_that_turns_the_spin() -> None:
    """d/dt of J_b omega n, n the spin axis tilted by alpha about x and gamma about z."""
    matrices = tub_matrices()
    spin, step = 9.0, 1e-6
    gyroscopic = np.array(matrices.gyroscopic.subs({"J_b": 0.9, "omega": 10.0}), dtype=float)

    def momentum(alpha: float, gamma: float) -> np.ndarray:
        return spin * np.array([-np.sin(gamma) * np.cos(alpha), np.cos(gamma) * np.cos(alpha), np.sin(alpha)])

    rates = np.array([0.7, -0.4])
    torque = (momentum(*(step * rates)) - momentum(*(-step * rates))) / (2 * step)
    # Central difference: step^2; rounding eps/step.
    got = gyroscopic @ np.array([0, 0, 0, rates[0], 0, rates[1]])
    np.testing.assert_allclose(got[[3, 5]], torque[[0, 2]], rtol=0, atol=1e-8)


@kills(
    "validation.cases.errata.formulas:_polar_moment_about_axis",
    "(r[:, None] * np.sin(angle)) ** 2",
    "0.0 * r[:, None]",
)
def test_polar_moment() -> None:
    """Steiner: pi r^4/2 + pi r^2 d^2."""
    assert formulas._polar_moment_about_axis(0.3, 0.2) == pytest.approx(
        np.pi * (0.3**4 / 2 + 0.3**2 * 0.2**2), rel=1e-14
    )


def test_compare_decides_the_verdict() -> None:
    assert compare("g/a", "X20", "q", 1.01, 1.0, tolerance=0.02).verdict == "agrees"
    case = compare("g/a", "X20", "q", 1.05, 1.0, tolerance=0.02, otherwise="trend")
    assert case.verdict == "trend"
    assert case.difference == pytest.approx(0.05)
    assert compare("g/a", "X20", "q", 2.1, 1.0, tolerance=0.02, otherwise="trend").verdict == "differs"
    assert compare("g/a", "X20", "q", 0.0, 0.0, tolerance=0.0).verdict == "agrees"
    assert compare("g/a", "X20", "q", -2.0, -1.0, tolerance=0.0).difference == -1.0


def test_case_rejects_what_a_report_cannot_show() -> None:
    with pytest.raises(InputError) as caught:
        Case("g/a", "X20", "q", 1.0, math.nan, 0.0, "agrees")
    assert caught.value.field == "computed"
    with pytest.raises(InputError) as caught:
        Case("g/a", "X20", "q", 1.0, 1.0, 0.0, "wrong")  # type: ignore[arg-type]
    assert caught.value.field == "verdict"


@pytest.mark.parametrize(
    ("measured", "computed", "without", "alike"),
    [
        (1.0, 2.0, None, True),
        (1.0, 2.1, None, False),
        (2.1, 1.0, None, False),
        (1.0, -1.0, None, False),
        (0.0, 0.1, None, False),
        (0.0, 0.0, None, True),
        # A peak that falls to 0.11 and one that falls to 0.94 of itself: the fall is 14 times as large.
        (0.11, 0.94, 1.0, False),
        # Within a factor of two of what is left, not of what is taken away; and the other way round.
        (0.9, 0.5, 1.0, False),
        (0.11, 0.02, 1.0, False),
        (0.5, 0.4, 1.0, True),
    ],
)
def test_a_trend_is_as_large_within_a_factor_of_two(
    measured: float, computed: float, without: float | None, alike: bool
) -> None:
    effect = Effect("share", measured, computed, without)
    assert effect.alike is alike
    assert shape_verdict(True, effect) == ("trend" if alike else "differs")
    assert shape_verdict(False, effect) == "differs"
    if not alike:
        with pytest.raises(InputError, match="factor of 2"):
            Case("g/a", "X20", "q", "falls", "falls", "the same shape", "trend", effect=effect)


def test_a_trend_tells_the_size_of_its_effect_unless_the_source_has_words_alone() -> None:
    assert Case("g/a", "X20", "q", "grows", "1, 2", "the same", "trend").effect is None
    for printed in (7.0, None):
        with pytest.raises(InputError) as caught:
            Case("g/a", "X20", "q", printed, 7.1, "near", "trend")
        assert caught.value.field == "effect"


def test_expressions_stand_as_on_paper() -> None:
    """`c_x y^2`, not `c_x*y**2`: where the words go through Markdown, asterisks would be emphasis."""
    texts = [
        text
        for case in by_name().values()
        for text in (case.quantity, case.note, case.source, case.printed, case.computed)
        if isinstance(text, str)
    ]
    assert len(texts) > 100 and not [text for text in texts if re.search(r"[*`$\\]", text)]
