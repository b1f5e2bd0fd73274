"""Optimal volume: exact, by finite elements, as printed; and what the source says of it [DR18, eq. 18-19]."""

from __future__ import annotations

from leblanc.studies.volume.study import answer_volume
from meshes.chamber import Chamber
from solvers.statics.hydrostatics import optimal_volume
from solvers.synchronous.models import Statics
from validation.cases.case import Case, Origin, compare

_GRAVITY = 9.81
_ML = 1e6
_SETS = (((0.2, 0.05), 90.0), ((0.2, 0.05), 20.0), ((0.05, 0.02), 100.0))


def cases() -> list[Case]:
    """Finite elements against closed form, the printed formula, the layer of 2 e, and the law's bend."""
    found = []
    for (radius, height), speed in _SETS:
        for e in (1e-3, 3e-3, 10e-3):
            answer = answer_volume(radius, height, e, speed, gravity=_GRAVITY)
            at = f"R {radius:g} m, h {height:g} m, {speed:g} rad/s, e {e * 1e3:g} mm"
            name = f"{radius * 1e3:g}-{speed:g}-{e * 1e3:g}"
            found.append(
                compare(
                    f"optimal_volume/fem-{name}",
                    "scikit-fem, quadratic triangles",
                    f"optimal volume, ml: {at}",
                    answer.optimal_volume_fem * _ML,
                    answer.optimal_volume * _ML,
                    tolerance=1e-6,
                    origin=Origin("second code", "scikit-fem, quadratic triangles"),
                    note="the mesh's wall runs inside the circle by the amount it was chosen for",
                )
            )
            if answer.printed_eq18 is not None:
                found.append(
                    compare(
                        f"optimal_volume/eq18-{name}",
                        "DR18, eq. 18",
                        f"optimal volume, ml: {at}",
                        answer.printed_eq18 * _ML,
                        answer.optimal_volume * _ML,
                        tolerance=0.05,
                        otherwise="erratum",
                    )
                )
    return [*found, _double_thickness(), _bend()]


def _double_thickness() -> Case:
    """At fast spin the layer opposite the dry point is 2 e thick."""
    chamber, e = Chamber(0.2, 0.05), 1e-3
    volume = float(optimal_volume(chamber, e, 1.0, gravity=0.0))
    # A crescent between circles of radius R and R - e that touch: twice its mean thickness is its largest.
    mean = volume / (3.141592653589793 * (2 * chamber.radius - e) * chamber.height)
    return compare(
        "optimal_volume/thickness",
        "DR18, eq. 19",
        "thickness of the layer opposite the dry point over e, fast spin",
        2.0,
        2.0 * mean / e,
        tolerance=1e-9,
    )


def _bend() -> Case:
    """The deflection at which a volume stops to be enough is the one whose optimal volume it is."""
    import numpy as np

    from fluid.fill import Fill, Fills
    from fluid.liquid import known_liquid

    chamber, e = Chamber(0.2, 0.05), 3e-3
    volume = float(optimal_volume(chamber, e, 1.0, gravity=0.0))
    bend = Statics().linear_limit(
        Fills.of([Fill(chamber, known_liquid("water"), volume)]), np.array([50.0]), np.zeros(1)
    )
    return compare(
        "optimal_volume/bend",
        "theory: statics, eq. 9",
        "deflection at which the unbalance stops growing with a full chamber's mass, mm",
        e * 1e3,
        float(bend[0]) * 1e3,
        tolerance=1e-8,
        note="no gravity along the axis",
        origin=Origin("closed form", "volume that touches the wall, turned round"),
    )
