"""A flexible rotor of ROSS with a liquid balancer: unbalance response, Campbell diagram, self-excited whirl.

Beside it the Jeffcott rotor to which its first bending mode reduces, with the same liquid in this package's
own solvers. Needs the extra: pip install 'leblanc[ross]'. Every value of the machine is assumed.

    python examples/ross_flexible_rotor.py --out out/ross_flexible_rotor
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from leblanc.core.units import RPM
from leblanc.plotting.page import Figure, Frame, lay_out, number, save, style
from meshes.arrays import Array, Complex
from meshes.chamber import Chamber
from solvers.ross import liquid_layer
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth

ELEMENTS, LENGTH, DRUM = 8, 1.0, 4  # of the shaft, m, and the node at mid-span where the drum sits
LIQUID = ELEMENTS + 1  # the first node beyond the shaft's
UNBALANCE = 5e-4  # kg m
CHAMBER = Chamber(radius=0.12, height=0.03)
# A layer of a tenth of the radius; friction as of a chamber with baffles, 1/s.
FILL = Fill(CHAMBER, known_liquid("water"), 0.19 * CHAMBER.capacity)
FRICTION = Friction(FrictionLaw.LINEAR, 6.0)
SPEEDS = np.linspace(50.0, 650.0, 301)  # rad/s
SPINS = np.linspace(50.0, 650.0, 121)  # of the modes, rad/s
BLUE, ORANGE = "#0072B2", "#D55E00"
HOLLOW = {"linestyle": "", "markerfacecolor": "none", "markeredgewidth": 0.9}


@dataclass(frozen=True)
class Lateral:
    """Modes in which the drum's axis moves, at some spins.

    Parameters
    ----------
    spin : rad/s, one entry per mode
    whirl_speed : rad/s, positive with the spin
    growth : 1/s
    """

    spin: Array
    whirl_speed: Array
    growth: Array

    def fastest(self) -> Array:
        """Largest growth at each of SPINS, 1/s."""
        return np.array([self.growth[self.spin == spin].max() for spin in SPINS])


@dataclass(frozen=True)
class Comparison:
    """What ROSS and the reduced model say.

    Parameters
    ----------
    model : the reduced rotor
    dry, wet : deflections of the drum by ROSS, m, over SPEEDS
    own_dry, own_wet : those of the reduced model
    modes : of the rotor with liquid, by ROSS
    own_growth : of the reduced model, 1/s, over SPINS
    """

    model: Jeffcott
    dry: Complex
    wet: Complex
    own_dry: Complex
    own_wet: Complex
    modes: Lateral
    own_growth: Array


def machine(ross: Any, liquid: Any = None) -> Any:
    """Shaft of 40 mm on two bearings, a steel disc of 240 mm that carries the chamber.

    Parameters
    ----------
    ross : the module
    liquid : elements of the liquid; None for an empty chamber
    """
    steel = ross.Material("steel", rho=7810.0, E=2.11e11, G_s=8.12e10)
    shaft = [
        ross.ShaftElement(L=LENGTH / ELEMENTS, idl=0.0, odl=0.04, material=steel) for _ in range(ELEMENTS)
    ]
    disc = ross.DiskElement.from_geometry(n=DRUM, material=steel, width=0.03, i_d=0.04, o_d=0.24)
    supports = [
        ross.BearingElement(n=node, kxx=4e6, cxx=3e3, kzz=1e7, tag=f"bearing {node}")
        for node in (0, ELEMENTS)
    ]
    if liquid is None:
        return ross.Rotor(shaft, [disc], supports)
    return ross.Rotor(shaft, [disc], [*supports, *liquid.bearings], [liquid.mass])


def drum_deflection(rotor: Any) -> Complex:
    """Deflection of the drum along x under its unbalance, m, over SPEEDS."""
    found = rotor.run_unbalance_response(DRUM, UNBALANCE, 0.0, SPEEDS)
    return np.asarray(found.forced_resp[rotor.number_dof * DRUM])


def lateral_modes(rotor: Any) -> Lateral:
    """ROSS's modes at SPINS without the axial and torsional ones."""
    rows = []
    x = rotor.number_dof * DRUM
    for spin in SPINS:
        modal = rotor.run_modal(float(spin), sparse=False)
        for value, shape in zip(modal.evalues, modal.evectors.T, strict=True):
            first, second = shape[x], shape[x + 1]
            forward, backward = abs(first + 1j * second), abs(first - 1j * second)
            if value.imag > 0.0 and max(forward, backward) > 1e-6 * np.abs(shape[: rotor.ndof]).max():
                rows.append((spin, value.imag if forward > backward else -value.imag, value.real))
    return Lateral(*np.array(rows).T)


def reduced(rotor: Any) -> Jeffcott:
    """Jeffcott rotor of the first bending mode [theory: ross, eq. 9].

    Parameters
    ----------
    rotor : of ROSS, without liquid
    """
    modal = rotor.run_modal(0.0, sparse=False)
    shapes, x = modal.evectors[: rotor.ndof].T, rotor.number_dof * DRUM
    # At rest modes come in equal pairs; what one of them does in the plane of x and the axis is the mode.
    plane = [k for k in range(rotor.ndof) if k % rotor.number_dof in (0, 4)]
    moves = np.abs(shapes[:, x]) > 1e-6 * np.abs(shapes).max(axis=1)
    first = int(np.flatnonzero(moves & (modal.evalues.imag > 0.0))[0])
    value, shape = modal.evalues[first], shapes[first, plane] / shapes[first, x]
    mass = float(np.real(np.conj(shape) @ rotor.M(0.0)[np.ix_(plane, plane)] @ shape))
    return Jeffcott(mass, mass * abs(value) ** 2, -2.0 * mass * value.real, UNBALANCE)


def compare(ross: Any) -> Comparison:
    """Both models over spin.

    Parameters
    ----------
    ross : the module
    """
    # From 0: ROSS also looks coefficients up there.
    liquid = liquid_layer(FILL, DRUM, LIQUID, np.linspace(0.0, SPEEDS[-1], 8), FRICTION)
    dry_rotor, wet_rotor = machine(ross), machine(ross, liquid)
    model = reduced(dry_rotor)
    own = response(model, [FILL], SPEEDS, gravity=0.0)
    return Comparison(
        model=model,
        dry=drum_deflection(dry_rotor),
        wet=drum_deflection(wet_rotor),
        own_dry=own.deflection_dry,
        own_wet=own.deflection,
        modes=lateral_modes(wet_rotor),
        own_growth=asynchronous_growth(model.system(), [FILL], SPINS, FRICTION)[0],
    )


def edges(growth: Array) -> tuple[float, float]:
    """First and last spin of the self-excited whirl, rad/s, between the spins by straight lines.

    Parameters
    ----------
    growth : at SPINS, 1/s
    """
    inside = np.flatnonzero(growth > 0.0)
    low, high = inside[0], inside[-1]
    first = np.interp(0.0, growth[low - 1 : low + 1], SPINS[low - 1 : low + 1])
    last = np.interp(0.0, growth[high : high + 2][::-1], SPINS[high : high + 2][::-1])
    return float(first), float(last)


def draw_amplitude(axes: Any, found: Comparison) -> None:
    """Unbalance response with and without liquid."""
    rpm, few = SPEEDS * RPM, slice(4, None, 12)
    dashes = (0, (5, 1.5))
    axes.semilogy(rpm, 1e3 * np.abs(found.dry), color=ORANGE, linestyle=dashes, label="ROSS, without liquid")
    axes.semilogy(rpm, 1e3 * np.abs(found.wet), color=BLUE, label="ROSS, with liquid")
    axes.plot(
        rpm[few], 1e3 * np.abs(found.own_dry[few]), "s", color=ORANGE, label="reduced, without", **HOLLOW
    )
    axes.plot(rpm[few], 1e3 * np.abs(found.own_wet[few]), "o", color=BLUE, label="reduced, with", **HOLLOW)
    axes.yaxis.set_major_formatter(number)
    axes.set_ylabel("Amplitude (mm)")


def draw_modes(axes: Any, modes: Lateral) -> None:
    """Whirl speeds of the modes with liquid."""
    rpm, size = modes.spin * RPM, np.abs(modes.whirl_speed)
    grows, forward = modes.growth > 0.0, modes.whirl_speed > 0.0
    small = {"color": "0.45", "markersize": 2.2, "linestyle": ""}
    axes.plot(rpm[forward & ~grows], size[forward & ~grows], "o", label="forward mode", **small)
    axes.plot(rpm[~forward][::2], size[~forward][::2], "v", label="backward mode", **small)
    strong = {"color": ORANGE, "markersize": 5.0, "markeredgecolor": "black", "markeredgewidth": 0.4}
    axes.plot(rpm[grows], size[grows], "D", linestyle="", label="self-excited mode", **strong)
    axes.plot(
        SPINS * RPM, SPINS, color="black", linewidth=0.9, linestyle=(0, (6, 2)), label="whirl at the spin"
    )
    axes.set_ylim(0.0, 720.0)
    axes.set_ylabel("Whirl speed (rad/s)")


def draw_growth(axes: Any, found: Comparison) -> None:
    """Growth of the mode that grows most."""
    rpm = SPINS * RPM
    axes.plot(rpm, found.modes.fastest(), color=BLUE, label="ROSS, with liquid")
    axes.plot(rpm[::4], found.own_growth[::4], "o", color=BLUE, label="reduced, with", **HOLLOW)
    axes.axhline(0.0, color="black", linewidth=0.7)
    axes.set_ylabel("Growth (1/s)")
    axes.set_xlabel("Spin (rpm)")


def draw(found: Comparison) -> Figure:
    """Amplitude, whirl speeds and growth over the spin."""
    low, high = edges(found.modes.fastest())
    with style():
        figure = Figure()
        rows = [[figure.add_axes((0, 0, 1, 1), label=str(i))] for i in range(3)]
        (top,), (middle,), (bottom,) = rows
        draw_amplitude(top, found)
        draw_modes(middle, found.modes)
        draw_growth(bottom, found)
        for axes in (top, middle, bottom):
            axes.set_xlim(SPEEDS[0] * RPM, SPEEDS[-1] * RPM)
            axes.xaxis.set_major_formatter(number)
            axes.tick_params(labelbottom=axes is bottom)
            band = {"facecolor": "0.93", "edgecolor": "0.75", "hatch": "////", "linewidth": 0.0, "zorder": 0}
            axes.axvspan(low * RPM, high * RPM, label="self-excited whirl", **band)
        above = top.secondary_xaxis("top", functions=(lambda n: n / RPM, lambda w: w * RPM))
        above.set_xlabel("Spin (rad/s)")
        frame = Frame(left=0.72, top=0.46, between=0.12, below=0.42)
        lay_out(figure, rows, [2.1, 2.1, 1.3], frame, caption(found.model))
    return figure


def caption(model: Jeffcott) -> str:
    """What the figure shows."""
    return (
        f"Flexible rotor of ROSS, shaft of 40 mm, {model.mass:.1f} kg modal mass at the drum in mid-span. "
        f"Liquid balancer: {1e3 * FILL.volume:.3f} l of water, R = {1e3 * CHAMBER.radius:.0f} mm, mean depth "
        f"{1e3 * FILL.depth:.0f} mm. Unbalance {1e6 * UNBALANCE:.0f} g mm. Linear theory of the layer, "
        f"friction {FRICTION.coefficient:g} 1/s. Reduced: the Jeffcott rotor of the first bending mode. "
        "All values assumed."
    )


def main() -> None:
    """Solve, print the comparison, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/ross_flexible_rotor"))
    folder = parser.parse_args().out
    with warnings.catch_warnings():
        # Some of what ROSS imports warns about programs that it could use.
        warnings.simplefilter("ignore")
        import ross
    found = compare(ross)
    model = found.model
    print(
        f"reduced: {model.mass:.3f} kg, {model.natural_frequency:.2f} rad/s, ratio {model.damping_ratio:.4f}"
    )
    near = np.abs(SPEEDS / model.natural_frequency - 1.0) < 0.3
    for name, deflection, own in (("dry", found.dry, found.own_dry), ("wet", found.wet, found.own_wet)):
        peak, gap = np.abs(deflection).max(), np.abs(deflection - own)[near].max()
        print(
            f"{name}: peaks {1e3 * peak:.4f} and {1e3 * np.abs(own).max():.4f} mm, apart by {gap / peak:.2%}"
        )
        print(
            f"{name}: at {SPEEDS[-1]:g} rad/s {1e3 * abs(deflection[-1]):.5f} and {1e3 * abs(own[-1]):.5f} mm"
        )
    for name, growth in (("ROSS", found.modes.fastest()), ("reduced", found.own_growth)):
        low, high = edges(growth)
        print(f"{name}: grows from {low:.1f} to {high:.1f} rad/s, at most {growth.max():.3f} 1/s")
    save(draw(found), folder, "ross_flexible_rotor", "Flexible rotor with a liquid balancer")


if __name__ == "__main__":
    main()
