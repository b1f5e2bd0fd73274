"""Seeded faults of the long waves in SI units: forces, friction, changing spin, time steps, readings."""

from tests.faults import Fault
from tests.solvers.pypde import test_long_wave as oracle


def _terms(right: str, wrong: str, check=oracle.check_manufactured) -> Fault:  # type: ignore[no-untyped-def]
    return Fault("solvers.pypde.terms", right, wrong, check)


def _readings(right: str, wrong: str, check) -> Fault:  # type: ignore[no-untyped-def]
    return Fault("solvers.pypde.readings", right, wrong, check)


FAULTS: tuple[Fault, ...] = (
    # forces
    _terms("0.5 * terms.spin_rate * time) * time", "terms.spin_rate * time) * time"),
    _terms("whirl.speed * time - turned", "whirl.speed * time + turned"),
    _terms("- 1j * whirl.gravity", "+ 1j * whirl.gravity"),
    _terms("(part - math.sin(part))", "(part + math.sin(part))"),
    _terms("whirl.speed**2 * whirl.amplitude", "whirl.speed * whirl.amplitude"),
    _terms("force.imag * table[1], force", "-force.imag * table[1], force"),
    _terms("force.imag * table[3]", "-force.imag * table[3]"),
    _terms("self.whirl.spin + self.spin_rate", "self.whirl.spin - self.spin_rate"),
    _terms("rates(a, q, spin, terms.spin_rate", "rates(a, q, spin, 0.0", oracle.check_spin_up),
    _terms("rates(a, q, spin, terms.spin_rate", "rates(a, q, spin, -terms.spin_rate", oracle.check_spin_up),
    # friction
    _terms("d_q -= _shear", "d_q += _shear"),
    _terms("* held * u", "* u"),
    # the solver's own steps
    _terms("slip=whirl.slip", "slip=-whirl.slip", oracle.check_history),
    _terms("weight=whirl.gravity / radius", "weight=whirl.gravity", oracle.check_history),
    _terms("_lid(terms), _spread(terms, a))", "0.0, _spread(terms, a))", oracle.check_history),
    _terms("layer_log(a.mean())) ** 2", "layer_log(a.mean()))", oracle.check_history),
    # readings
    _readings("- 0.5 * depth", "- depth", oracle.check_synchronous),
    _readings("return 2.0 * area /", "return area /", oracle.check_synchronous),
    _readings(
        "- terms.spin(time) * np.square(area)",
        "+ terms.spin(time) * np.square(area)",
        oracle.check_synchronous,
    ),
    _readings("* fill.chamber.radius**2 * area", "* area", oracle.check_spin_up),
    _readings("terms.fill.chamber.radius**3", "terms.fill.chamber.radius**2", oracle.check_force),
    _readings("2.0 / 3.0 * a", "1.0 / 3.0 * a", oracle.check_force),
    _readings("ring(cells)[0] + 1j", "ring(cells)[0] - 1j", oracle.check_force),
)
