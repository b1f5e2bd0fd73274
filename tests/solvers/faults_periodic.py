"""Seeded faults of the steady waves, their curves and their stability."""

from tests.faults import Fault
from tests.solvers import test_continuation as curves
from tests.solvers import test_periodic as periodic

FAULTS = (
    # No linear oracle sees it.
    Fault("fluid.kdv", "3.0 * spin / surface_radius**2", "2.0 * spin / surface_radius**2",
          periodic.error_is_first_order_in_the_height),
    Fault("solvers.wave_modes", "problem.diffusion * n + problem.decay / n",
          "problem.diffusion * n**2 + problem.decay / n", periodic.power_balances),
    Fault("solvers.wave_modes", "problem.diffusion * n + problem.decay / n",
          "problem.diffusion * n + problem.decay * n", periodic.power_balances),
    Fault("solvers.wave_modes", "/ self.scale - 1j * damping", "/ self.scale + 1j * damping",
          periodic.linear_limit),
    Fault("solvers.wave_modes", "0.5 * problem.forcing * problem.steepening / self.scale**2",
          "problem.forcing * problem.steepening / self.scale**2", periodic.linear_limit),
    Fault("solvers.wave_modes", "r[0] -= self.half_forcing", "r[0] += self.half_forcing",
          periodic.collocation_agrees),
    Fault("solvers.wave_modes", "(self.diagonal - p) * v + 0.5 * square", "(self.diagonal - p) * v + square",
          periodic.cnoidal_waves_are_steady),
    Fault("solvers.wave_modes", "(self.diagonal - p) * v + 0.5 * square",
          "(self.diagonal + p) * v + 0.5 * square", periodic.cnoidal_waves_are_steady),
    Fault("solvers.wave_modes", "next_fast_len(3 * modes + 1", "next_fast_len(2 * modes + 1",
          periodic.products_do_not_alias),
    Fault("solvers.wave_modes", "np.subtract(hi, ti, out=matrix[:modes, modes:])",
          "np.add(hi, ti, out=matrix[:modes, modes:])", periodic.jacobian_is_the_derivative),
    Fault("solvers.wave_modes", "(m + 1) * item, (item, item)", "m * item, (item, item)",
          periodic.jacobian_is_the_derivative),
    Fault("solvers.periodic", "c.steepening, float(forcing(c, acceleration)), decay, diffusion",
          "c.steepening, float(forcing(c, acceleration)), diffusion, decay", curves.linear_spectrum),
    Fault("solvers.periodic", "float(np.sqrt(2.0) * np.linalg.norm(self.modes))",
          "float(np.linalg.norm(self.modes))", periodic.rms_is_that_of_the_profile),
    Fault("solvers.wave_stability", "np.vstack((n * jacobian[m:], -n * jacobian[:m]))",
          "np.vstack((-n * jacobian[m:], n * jacobian[:m]))", curves.linear_spectrum),
    Fault("solvers.wave_stability", "np.vstack((n * jacobian[m:], -n * jacobian[:m]))",
          "np.vstack((jacobian[m:], -jacobian[:m]))", curves.linear_spectrum),
    Fault("solvers.wave_stability", "np.argsort(-values.real)", "np.argsort(values.real)",
          curves.curve_folds),
    Fault("solvers.continuation", "matrix[:size, size] = -point[:-1]", "matrix[:size, size] = point[:-1]",
          curves.curve_folds),
    Fault("solvers.wave_response", "3.0 * chord - 2.0 * start - stop", "3.0 * chord - start - stop",
          curves.segments_follow_the_curve),
)  # fmt: skip
