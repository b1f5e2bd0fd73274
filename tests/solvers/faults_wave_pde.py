"""Seeded faults of the wave equations and of the exponential steppers."""

from tests.faults import Fault
from tests.solvers.waves import test_stepper
from tests.solvers.waves import test_terms as test_wave_terms


def _cnoidal() -> None:
    test_wave_terms.assert_cnoidal(test_wave_terms.PROGRADE)


def _linear() -> None:
    for c in test_wave_terms.LINEAR:
        test_wave_terms.assert_linear_waves(c, 40.0)


def _forced() -> None:
    test_wave_terms.assert_forced_from_rest(test_wave_terms.LINEAR[0], 2.0)


def _aliases() -> None:
    test_stepper.test_square_has_no_aliases(16)


def _time_alone() -> None:
    test_stepper.test_a_rest_that_depends_on_time_alone_is_followed()


def _wave_terms(right: str, wrong: str, oracle) -> Fault:  # type: ignore[no-untyped-def]
    return Fault("solvers.waves.terms", right, wrong, oracle)


def _weights(right: str, wrong: str, oracle=test_stepper.assert_phases) -> Fault:  # type: ignore[no-untyped-def]
    return Fault("solvers.waves.exponential", right, wrong, oracle)


def _stepper(right: str, wrong: str, oracle=test_stepper.assert_phases) -> Fault:  # type: ignore[no-untyped-def]
    return Fault("solvers.waves.stepper", right, wrong, oracle)


_OMEGA = "wave_frequency(n, terms.c, terms.whitham)"

FAULTS: tuple[Fault, ...] = (
    # the equation
    _wave_terms("-0.5j * terms.c.steepening", "0.5j * terms.c.steepening", _cnoidal),
    _wave_terms("0.5j * terms.c.steepening", "1.0j * terms.c.steepening", test_wave_terms.assert_sawtooth),
    _wave_terms("-1j * omega", "1j * omega", _linear),
    _wave_terms(_OMEGA, f"(2.0 * n * terms.c.linear_speed - {_OMEGA})", _cnoidal),
    _wave_terms(_OMEGA, "wave_frequency(n, terms.c, False)", _linear),
    _wave_terms("0.5j * terms.forcing", "-0.5j * terms.forcing", test_wave_terms.assert_push),
    _wave_terms("0.5j * terms.forcing", "1.0j * terms.forcing", _forced),
    _wave_terms("np.exp(1j * first_angle)", "np.exp(-1j * first_angle)", test_wave_terms.assert_push),
    _wave_terms("np.exp(-1j * terms.whirl_speed * t)", "np.exp(1j * terms.whirl_speed * t)", _forced),
    _wave_terms("- terms.damping,", "+ terms.damping,", test_wave_terms.assert_decay),
    _wave_terms("- terms.viscosity *", "+ terms.viscosity *", test_wave_terms.assert_decay),
    _wave_terms("terms.viscosity * np.square(n)", "terms.viscosity * n", test_wave_terms.assert_decay),
    _wave_terms("terms.viscosity * np.square(n)", "terms.viscosity * n", test_wave_terms.assert_manufactured),
    _wave_terms(
        "-0.5j * terms.c.steepening", "-0.4j * terms.c.steepening", test_wave_terms.assert_manufactured
    ),
    _wave_terms("0.5j * terms.forcing", "-0.5j * terms.forcing", test_wave_terms.assert_manufactured),
    _wave_terms(
        "-0.5j * terms.c.steepening * n",
        "-0.5j * terms.c.steepening * np.maximum(n, 1)",
        test_wave_terms.assert_invariants,
    ),
    # weights
    _weights("phi_1 - 3.0 * phi_2 + 4.0 * phi_3", "phi_1 - 3.0 * phi_2 + 2.0 * phi_3"),
    _weights("4.0 * phi_3 - phi_2", "4.0 * phi_3 + phi_2"),
    _weights("0.5 * half * np.expm1(0.5 * z)", "half * np.expm1(0.5 * z)"),
    _weights("full - 2.0 * full_2, 2.0 * full_2", "full - full_2, full_2"),
    _weights("half * half / 6.0, half / 3.0", "half * half / 6.0, half / 2.0"),
    _weights("(phi_2 - 0.5) / large", "(phi_2 - 1.0) / large", test_stepper.assert_phi),
    _weights("math.factorial(j + k)", "math.factorial(j)", test_stepper.assert_phi),
    _weights("symbol + turn", "symbol - turn"),
    _weights("near * b2", "b2"),
    # steps
    _stepper("w.b2 * (n2 + n3)", "w.b2 * (n2 + n2)"),
    _stepper("w.a41 * n1 + w.a43 * n3, t + h)", "w.a41 * n1 + w.a43 * n3, t + 0.5 * h)"),
    _stepper(
        "+ _BEND * bend", "+ 0.0 * bend", test_stepper.test_a_rest_that_depends_on_time_alone_is_followed
    ),
    _stepper("3 * points // 2", "points", _aliases),
)
