"""What each model of the liquid does and what it takes for granted, in words."""

from __future__ import annotations

from collections.abc import Iterable

# What the model does, and what it takes for granted.
MODELS = {
    "statics": (
        "At each speed the liquid rests in the turning drum, its free surface a paraboloid about the "
        "rotation axis that holds the given volume.",
        "This takes steady synchronous whirl for granted and a liquid that friction has brought up to the "
        "drum's speed; waves, self-excited whirl and surface tension are left out.",
    ),
    "linear": (
        "The liquid answers with small waves on a rigidly turning ring, by the exact linear theory of plane "
        "frictionless flow.",
        "This takes a wet wall all round for granted, disturbances small against the depth of the layer, and "
        "a layer of the same depth all along the axis.",
    ),
    "long_wave": (
        "The liquid answers with long waves of any height in an annular layer, bores included, which keep "
        "mass and angular momentum.",
        "This takes a layer thin against its waves for granted, the pressure of a layer without radial "
        "acceleration, and the same depth all along the axis.",
    ),
    "kdv": (
        "The liquid answers with one family of weakly nonlinear, dispersive waves that stand still as seen "
        "from the whirl.",
        "This takes whirl near the resonance of that family for granted, and waves low against the depth of "
        "the layer.",
    ),
    "fem": (
        "The liquid answers with small disturbances, by finite elements on the section of the chamber.",
        "This takes plane frictionless flow for granted, disturbances small against the depth of the layer, "
        "and an undisturbed surface that is a circle.",
    ),
}

WHIRL = (
    "At each speed and volume the free whirls of rotor and liquid together, the liquid by the exact linear "
    "theory of the plane layer with the laminar or linear friction of its wall; told is the one that grows "
    "most.",
    "This takes whirls for granted that are small against the depth of the layer, a wet wall all round and "
    "the same depth all along the axis; how far a whirl grows is not asked.",
)

BALLS = (
    "Speeds at which all balls can stick together and the vibration that follows are those of the lowest "
    "order in the balls' share of the moving mass; the critical speed and a few speeds beside the formulas "
    "come from the full equations in time.",
    "This takes balls for granted that roll without sliding and without contact with one another, a shaft "
    "that keeps its speed, a platform that moves along one line, and no gravity.",
)


def described(names: Iterable[str]) -> list[tuple[str, str]]:
    """Name of each model once, with what it does and takes for granted; nothing of one that is not known.

    Parameters
    ----------
    names : of models, in any order
    """
    return [(name, " ".join(MODELS.get(name, ()))) for name in dict.fromkeys(names)]
