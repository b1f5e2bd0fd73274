"""ROSS on the unbalance response of a rigid rotor in two supports.

ROSS builds rotors of beams: a light stiff shaft of one element with a disc at each end has twelve degrees of
freedom, of which four are those of the rigid rotor. Beside it stand this package's rigid rotor, and this
package's solver on ROSS's own twelve by twelve matrices.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np

from meshes.arrays import Array, Complex
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import unbalance_response
from validation.benchmarks.timing import Contestant, Go, Sample, measure, one_core

CODE, PACKAGE = "ROSS", "ross/ross-rotordynamics"
_OURS = "leblanc"


def _speeds() -> Array:
    return np.linspace(5.3, 600.0, 1000)


@dataclass(frozen=True)
class RotorProblem:
    """Discs on the ends of a shaft, both ends in isotropic supports; the unbalance sits on the first disc."""

    mass: tuple[float, float] = (6.0, 4.0)  #: of the discs, kg
    transverse: tuple[float, float] = (0.02, 0.01)  #: inertias of the discs, kg m^2
    polar: tuple[float, float] = (0.035, 0.018)
    stiffness: tuple[float, float] = (2e5, 3e5)  #: of the supports, N/m and N s/m
    damping: tuple[float, float] = (200.0, 250.0)
    length: float = 0.3  #: of the shaft, m, m, kg/m^3, Pa
    diameter: float = 0.1
    density: float = 78.0
    modulus: float = 2e14
    unbalance: float = 1e-4  #: kg m
    speed: Array = field(default_factory=_speeds)  #: rad/s, shape (n,)

    def rigid(self) -> TwoPlane:
        """The rotor with a rigid shaft."""
        shaft = self.density * 0.25 * math.pi * self.diameter**2 * self.length
        masses = np.array([*self.mass, shaft])
        places = np.array([0.0, self.length, 0.5 * self.length])
        places = places - masses @ places / masses.sum()
        own = [*self.transverse, shaft * (self.diameter**2 / 16.0 + self.length**2 / 12.0)]
        first, last = float(places[0]), float(places[1])
        return TwoPlane(
            mass=float(masses.sum()),
            transverse_inertia=float(sum(own) + masses @ np.square(places)),
            polar_inertia=sum(self.polar) + shaft * self.diameter**2 / 8.0,
            supports=tuple(map(Support, (first, last), self.stiffness, self.damping)),
            unbalances=(PlaneUnbalance(first, self.unbalance),),
        )

    def exact(self) -> Complex:
        """Deflection of the first disc, m: two complex equations for circular whirl, by Cramer's rule."""
        rotor, w = self.rigid(), self.speed
        place = np.array([support.position for support in rotor.supports])
        supports = np.array([k + 1j * w * c for k, c in zip(self.stiffness, self.damping, strict=True)])
        direct = supports.sum(axis=0) - rotor.mass * w**2
        crossed = place @ supports
        turning = np.square(place) @ supports - (rotor.transverse_inertia - rotor.polar_inertia) * w**2
        force, arm = self.unbalance * w**2, place[0]
        moved = force * (turning - arm * crossed)
        turned = force * (arm * direct - crossed)
        return np.asarray((moved + arm * turned) / (direct * turning - crossed**2))


def unbalance(problem: RotorProblem) -> list[Contestant]:
    """ROSS's own run and this package's two."""
    rigid = problem.rigid()
    first = rigid.supports[0].position

    def ours() -> Callable[[], Go]:
        system = rigid.system()
        return lambda: lambda: unbalance_response(system, problem.speed) @ system.at(first)[0]

    def large() -> Callable[[], Go]:
        system = _system(_rotor(_ross(), problem), problem.unbalance)
        return lambda: lambda: unbalance_response(system, problem.speed)[:, 0]

    def theirs() -> Callable[[], Go]:
        ross = _ross()

        def fresh() -> Go:
            # A new rotor each time: ROSS keeps the answers of the last speeds.
            rotor = _rotor(ross, problem)
            return lambda: rotor.run_unbalance_response(0, problem.unbalance, 0.0, problem.speed).forced_resp[
                0
            ]

        return fresh

    return [
        Contestant(_OURS, "rigid rotor, 4 degrees of freedom", ours, size=4),
        Contestant(_OURS, "matrices of ROSS, 12 degrees of freedom", large, size=12),
        Contestant(CODE, "stiff shaft, 12 degrees of freedom", theirs, size=12),
    ]


def compare(problem: RotorProblem | None = None, repeats: int = 5) -> list[Sample]:
    """Times side by side, by default of 1000 speeds; error: largest of the deflection over the largest."""
    given = problem or RotorProblem()
    exact = given.exact()
    size = float(np.abs(exact).max())
    return measure(unbalance(given), lambda found: float(np.abs(found - exact).max()) / size, repeats)


def _ross() -> ModuleType:
    with warnings.catch_warnings():
        # Some of what ROSS imports warns about programs that it could use.
        warnings.simplefilter("ignore")
        import ross
    module: ModuleType = ross
    return module


def _rotor(ross: ModuleType, problem: RotorProblem) -> Any:
    """The rotor in ROSS, its shaft one element."""
    p = problem
    stuff = ross.Material("stiff", rho=p.density, E=p.modulus, G_s=0.4 * p.modulus)
    shaft = [ross.ShaftElement(L=p.length, idl=0.0, odl=p.diameter, material=stuff)]
    ends = (0, 1)
    discs = [ross.DiskElement(n=i, m=p.mass[i], Id=p.transverse[i], Ip=p.polar[i]) for i in ends]
    supports = [
        ross.BearingElement(n=i, kxx=p.stiffness[i], cxx=p.damping[i], kzz=1e6, tag=f"support {i}")
        for i in ends
    ]
    return ross.Rotor(shaft, discs, supports)


def _system(rotor: Any, size: float) -> RotorSystem:
    """ROSS's matrices behind this package's interface."""
    n = rotor.ndof
    centre = np.zeros((2, n))
    centre[0, 0] = centre[1, 1] = 1.0
    return RotorSystem(
        coordinates=tuple(f"q{k}" for k in range(n)),
        mass=rotor.M(0.0),
        damping=rotor.C(0.0),
        gyroscopic=rotor.G(),
        stiffness=rotor.K(0.0),
        unbalance=size * (centre.T @ np.array([1.0, -1j])),
        centre=centre,
        lean=np.zeros((2, n)),
    )


def main() -> None:
    """Print the times of one run on one core."""
    from threadpoolctl import threadpool_limits

    one_core()
    with threadpool_limits(1):
        samples = compare()
    for sample in samples:
        milliseconds = 1e3 * sample.seconds
        print(
            f"{sample.code:8} {sample.setting:42} {milliseconds:9.2f} ms  "
            f"error {sample.error:.1e} {sample.note}"
        )


if __name__ == "__main__":
    main()
