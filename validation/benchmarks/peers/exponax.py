"""exponax (JAX, exponential Runge-Kutta, Fourier) on the benchmarks' problems, in double precision.

Its base stepper takes any linear symbol and nonlinear function; both are written as its own steppers are. The
released ETDRK coefficients keep only their real parts, which holds for real symbols and leaves first order in
time for dispersive ones. Both are shown: as released, and with the complex coefficients put in.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from meshes.arrays import Array
from solvers.waves.stepper import phi_functions
from validation.benchmarks.problems import SteadyProblem, TravellingProblem, spectrum
from validation.benchmarks.timing import Contestant, Go

CODE, PACKAGE = "exponax", "exponax"


def steady(problem: SteadyProblem, quick: bool = False) -> list[Contestant]:
    """ETDRK4 from rest in the frame of the whirl."""
    linear = (problem.drift, problem.waves.diffusion, problem.waves.decay, problem.c.dispersion)
    size = 0.5 * problem.waves.forcing

    def contestant(points: int, dt: float, right: bool, fraction: float) -> Contestant:
        build = _builder(
            linear, problem.waves.steepening, size, points, dt, problem.time, None, right, fraction
        )
        return Contestant(_name(right), f"ETDRK4, {points} points, dt {dt:g} s", build, size=points)

    if quick:
        return [contestant(96, 0.03, True, 2.0 / 3.0)]
    runs = [contestant(n, dt, True, 2.0 / 3.0) for n, dt in ((80, 0.06), (96, 0.03))]
    runs += [contestant(n, dt, True, 1.0) for n, dt in ((60, 0.08), (64, 0.1), (64, 0.12), (64, 0.16))]
    return runs + [contestant(96, dt, False, 2.0 / 3.0) for dt in (1e-3, 2.5e-4, 6e-5)]


def travelling(problem: TravellingProblem, quick: bool = False) -> list[Contestant]:
    """ETDRK4 with steps of several lengths, with as many points as each deserves."""
    linear = (0.0, 0.0, 0.0, problem.c.dispersion)

    def contestant(points: int, steps: int, right: bool) -> Contestant:
        dt = problem.time / steps
        build = _builder(
            linear, problem.c.steepening, 0.0, points, dt, problem.time, problem.start, right, 2.0 / 3.0
        )
        return Contestant(_name(right), f"ETDRK4, {points} points, {steps} steps", build, size=points)

    if quick:
        return [contestant(96, 400, True)]
    right = ((96, 500), (96, 1000), (120, 1500), (144, 2000), (192, 4000), (240, 8000))
    return [contestant(n, k, True) for n, k in right] + [
        contestant(96, k, False) for k in (1000, 10000, 100000)
    ]


def _name(right: bool) -> str:
    return f"{CODE}, complex coefficients" if right else CODE


def _builder(
    linear: tuple[float, float, float, float],
    steepening: float,
    push: float,
    points: int,
    dt: float,
    time: float,
    start: Callable[[Array], Array] | None,
    right: bool,
    fraction: float,
) -> Callable[[], Callable[[], Go]]:
    """What builds a run of whole steps of about dt that ends at the time; compiled by jax.jit."""

    def build() -> Callable[[], Go]:
        import jax
        import jax.numpy as jnp
        from exponax import fft, ifft, repeat

        jax.config.update("jax_enable_x64", True)
        steps = max(1, math.ceil(time / dt * (1.0 - 1e-12)))
        stepper = _stepper(linear, steepening, push, points, time / steps, fraction)
        if right:
            stepper = _with_complex_coefficients(stepper)
        # The transforms at both ends are done once, not in each step.
        advance = repeat(stepper.step_fourier, steps)
        run = jax.jit(
            lambda u: ifft(advance(fft(u, num_spatial_dims=1)), num_spatial_dims=1, num_points=points)
        )
        theta = 2.0 * np.pi * np.arange(points) / points
        first = jnp.asarray((start(theta) if start else np.zeros(points))[None])

        def go() -> Any:
            return spectrum(np.asarray(run(first).block_until_ready())[0])

        return lambda: go

    return build


def _stepper(
    linear: tuple[float, float, float, float],
    steepening: float,
    push: float,
    points: int,
    dt: float,
    fraction: float,
) -> Any:
    """The equation as exponax states equations; the forcing is -2 push sin(x)."""
    import jax.numpy as jnp
    from exponax import BaseStepper
    from exponax.nonlin_fun import ConvectionNonlinearFun

    drift, diffusion, decay, dispersion = linear

    class Forced(ConvectionNonlinearFun):  # type: ignore[misc]
        """Steepening and a constant force on the first mode."""

        force: Any

        def __call__(self, u_hat: Any) -> Any:
            return super().__call__(u_hat) + self.force

    class Wave(BaseStepper):  # type: ignore[misc]
        """KdV-Burgers with decay."""

        def _build_linear_operator(self, derivative_operator: Any) -> Any:
            d = derivative_operator
            return -drift * d + diffusion * d**2 - dispersion * d**3 - decay

        def _build_nonlinear_fun(self, derivative_operator: Any) -> Any:
            options = {"derivative_operator": derivative_operator, "dealiasing_fraction": fraction}
            options |= {"scale": steepening, "conservative": True}
            if push == 0.0:
                return ConvectionNonlinearFun(1, points, **options)
            made = Forced.__new__(Forced)
            ConvectionNonlinearFun.__init__(made, 1, points, **options)
            force = np.zeros((1, points // 2 + 1), dtype=complex)
            force[0, 1] = 1j * push * points
            object.__setattr__(made, "force", jnp.asarray(force))
            return made

    return Wave(1, 2.0 * math.pi, points, dt, num_channels=1, order=4)


def _with_complex_coefficients(stepper: Any) -> Any:
    """The same stepper with Cox and Matthews' coefficients as complex numbers [theory: steppers, eq. 4-5]."""
    import equinox
    import jax.numpy as jnp
    from exponax import spectral

    symbol = stepper._build_linear_operator(
        spectral.build_derivative_operator(1, stepper.domain_extent, stepper.num_points)
    )
    z = np.asarray(symbol) * stepper.dt
    half, (first, two, three) = phi_functions(0.5 * z)[0], phi_functions(z)
    weights = (
        0.5 * half,
        0.5 * half,
        0.5 * half,
        first - 3.0 * two + 4.0 * three,
        two - 2.0 * three,
        4.0 * three - two,
    )
    names = [f"_coef_{k}" for k in range(1, 7)]
    return equinox.tree_at(
        lambda tree: [getattr(tree._integrator, name) for name in names],
        stepper,
        [jnp.asarray(stepper.dt * w) for w in weights],
    )
