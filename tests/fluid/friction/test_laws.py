"""The laws of wall friction as objects, from their names to the numbers that compiled code takes."""

from __future__ import annotations

import json

import pytest

from fluid.friction.laws import (
    LINEAR,
    NO_FRICTION,
    NONE,
    QUADRATIC,
    STOKES,
    WALL,
    Friction,
    FrictionLaw,
    damping_rate,
)
from meshes.errors import InputError


def test_laws_are_known_by_name_and_number() -> None:
    assert [law.number for law in FrictionLaw] == [NONE, LINEAR, STOKES, QUADRATIC, WALL]
    assert Friction("linear", 0.5) == Friction(FrictionLaw.LINEAR, 0.5)  # type: ignore[arg-type]
    assert Friction() == NO_FRICTION
    # As scenes write it into their digest and results into their JSON.
    assert json.dumps(Friction("stokes").law) == '"stokes"'  # type: ignore[arg-type]


def test_only_the_laminar_law_asks_for_the_motion() -> None:
    for law, coefficient in (
        (FrictionLaw.LINEAR, 0.7),
        (FrictionLaw.QUADRATIC, 0.02),
        (FrictionLaw.NONE, 0.0),
    ):
        assert Friction(law, coefficient).at(1e-6, 30.0, 0.25) == (law.number, coefficient)
    # sqrt(nu |s|/2)/R by hand: sqrt(1e-6 * 18/2) = 3e-3.
    for frequency in (18.0, -18.0):
        law, coefficient = Friction(FrictionLaw.STOKES).at(1e-6, frequency, 0.25)
        assert coefficient == pytest.approx(3e-3 / 0.25, rel=1e-12)
        # Without floor and lid the rate is the shear over the area.
        assert damping_rate(law, coefficient, 0.0, 0.1, 0.1, 0.0) == pytest.approx(
            3e-3 / 0.25 / 0.1, rel=1e-12
        )


@pytest.mark.parametrize(
    ("law", "coefficient"), [("honey", 0.0), (2, 0.0), ("linear", -1.0), ("linear", float("nan"))]
)
def test_wrong_friction_is_refused(law: object, coefficient: float) -> None:
    with pytest.raises(InputError, match="friction"):
        Friction(law, coefficient)  # type: ignore[arg-type]
