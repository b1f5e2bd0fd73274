"""The symbols of the theory: name in the code, sign in the text, unit, meaning.

`python -m fluid.notation` prints the tables of docs/symbols.md, which are made from these.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Symbol:
    """A symbol of the theory and the quantity that it stands for."""

    name: str  #: as arguments and fields are called
    sign: str  #: in the theory pages, TeX
    unit: str  #: SI; empty for a pure number
    meaning: str  #: in words


CHAMBER = (
    Symbol("radius", "R", "m", "wall radius of the chamber"),
    Symbol("inner_radius", "R_i", "m", "inner wall radius of an annular chamber, 0 without one"),
    Symbol("height", "h_c", "m", "height of the chamber along the axis"),
    Symbol("volume", "V", "m^3", "volume of the liquid"),
    Symbol("density", r"\rho", "kg/m^3", "density of the liquid"),
    Symbol("viscosity", r"\nu", "m^2/s", "kinematic viscosity of the liquid"),
    Symbol("full_mass", "m_f", "kg", r"mass of liquid that would fill the cylinder, $\rho\pi R^2 h_c$"),
)
MOTION = (
    Symbol("speed, spin", r"\Omega", "rad/s", "spin speed of the rotor"),
    Symbol("whirl_speed", r"\omega_w", "rad/s", "whirl speed in space, positive with the spin"),
    Symbol("slip", "s", "rad/s", r"whirl speed seen from the drum, $\omega_w - \Omega$; 0 if synchronous"),
    Symbol("whirl_ratio", "q", "", r"$\omega_w/\Omega$"),
    Symbol("deflection", "w", "m", "deflection of the geometric axis, complex, in the frame of the drum"),
    Symbol("amplitude, whirl_amplitude", "w_0, e", "m", "modulus of the deflection"),
    Symbol("unbalance", "U", "kg m", "mass times its distance from the axis"),
    Symbol("growth", r"-\mathrm{Im}\,\omega", "1/s", "growth rate of a whirl"),
    Symbol("pull", "f_r", "m/s^2", r"radial part of the body force in the drum frame"),
)
LAYER = (
    Symbol("surface_radius", "a", "m", "radius of the free surface of the layer at rest"),
    Symbol("free_surface_radius", "r_s", "m", "local radius of the free surface"),
    Symbol("depth", "h_0, h", "m", "depth of the layer at rest, local depth"),
    Symbol("layer_log", "L", "", r"$\ln(R/r_s)$, the depth in conformal measure"),
    Symbol("layer_tanh", "T", "", r"$\tanh L$"),
    Symbol("rate", "k", "1/s", "rate at which friction takes the liquid's velocity in the drum"),
    Symbol("curvature", r"\kappa", "", "$(R/a)^2$"),
    Symbol("area", "A", "m^2", "liquid area per radian, $(R^2 - r_s^2)/2$"),
    Symbol("velocity", "u", "m/s", "velocity along the wall relative to the drum, positive with the spin"),
    Symbol("momentum, q", "q", "m^4/s", r"relative angular momentum per radian, $R u A - \Omega A^2$"),
    Symbol("static_head", "B", "m^2/s^2", "Bernoulli's function of the liquid at rest"),
    Symbol("force_ratio", "G", "", r"force on the drum over $m_f \omega_w^2 w_0$"),
    Symbol("offset", "d", "m", "centre of mass of the liquid from the geometric axis, complex"),
    Symbol("steepness", r"\beta", "1/m", r"steepness of the paraboloid, $\Omega^2/2g$"),
)
WAVES = (
    Symbol("mode", "n", "", "number of crests round the drum"),
    Symbol("linear_speed", r"\lambda_0", "rad/s", "angular speed of long waves of one family in the drum"),
    Symbol("steepening", r"\alpha", "1/(m^2 s)", "growth of that speed with the liquid area"),
    Symbol("dispersion", r"\delta", "rad^3/s", "loss of that speed with the square of the mode"),
    Symbol("profile", r"\eta", "m^2", "$A$ less its mean"),
    Symbol("damping, decay", r"\gamma", "1/s", "decay of a wave's amplitude"),
    Symbol("diffusion", r"\nu_b", "rad^2/s", "diffusion of a wave along the drum"),
    Symbol("forcing", "F", "m/s^2", r"acceleration of the axis, $\omega_w^2 w_0$"),
)
MACHINE = (
    Symbol("matrices", "M, C, G, K", "", "mass, damping, gyroscopic (for 1 rad/s) and stiffness of a rotor"),
    Symbol("coordinates", "q", "", "of a rotor, in the standing frame from the static equilibrium"),
    Symbol("planes, at", "B_j", "", "displacement of the axis at a chamber for unit coordinates"),
    Symbol("moment", "P", "kg m", "first moment of a layer about its chamber's axis, in the drum frame"),
    Symbol("relative_momentum", "N", "kg m/s", "momentum of a layer relative to its axis, standing frame"),
    Symbol("acceleration, guess", r"\bar a", "m/s^2", "mean acceleration of a chamber's axis over a step"),
)
GROUPS = {
    "The chamber": CHAMBER,
    "The motion": MOTION,
    "The layer": LAYER,
    "Waves of one family": WAVES,
    "The coupled machine": MACHINE,
}


def page() -> str:
    """The tables in Markdown."""
    lines = [
        "## Symbols",
        "",
        "SI units, angles in radians, complex numbers for vectors in the plane. The frame turns with the",
        "drum and its origin is the geometric axis, unless a page says otherwise.",
    ]
    for title, symbols in GROUPS.items():
        lines += ["", f"### {title}", "", "| in the code | symbol | unit | meaning |", "|---|---|---|---|"]
        lines += [f"| `{s.name}` | ${s.sign}$ | {s.unit or '1'} | {s.meaning} |" for s in symbols]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(page(), end="")
