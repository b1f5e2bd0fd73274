"""The liquid's answer to one prescribed whirl, from rest or settled, and the wave that runs by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import FRICTION, LIQUID, SCENE, Option, Quantity, Reader, ask, called
from leblanc.core.units import ACCELERATION, ANGULAR_SPEED, LENGTH, TIME, VOLUME

if TYPE_CHECKING:
    from leblanc.scene.scene import SceneOrPath
    from leblanc.studies.layer.answer import AnyLayerAnswer

FILES = ("wave.svg", "periods.svg", "layer.nc")
_FILM = Reader("leblanc.plotting.page:film_path")


def layer(
    scene: Annotated[
        SceneOrPath | None, SCENE, "Machine file, in place of what follows up to the height."
    ] = None,
    *,
    chamber: Annotated[int | None, "Which chamber of the machine [default: 1]."] = None,
    radius: Annotated[Quantity | None, LENGTH, "Wall radius, m or with a unit."] = None,
    height: Annotated[Quantity | None, LENGTH, "Height of the chamber along the axis."] = None,
    volume: Annotated[Quantity | None, VOLUME, "Volume of the liquid [default: the machine's]."] = None,
    speed: Annotated[
        Quantity | None, ANGULAR_SPEED, "Spin speed, rad/s or with a unit [default: the machine's last]."
    ] = None,
    whirl_speed: Annotated[
        Quantity | None, ANGULAR_SPEED, "Whirl speed in space; left out where gravity alone drives."
    ] = None,
    whirl_amplitude: Annotated[
        Quantity | None, LENGTH, "Radius of the whirl [default: 0 with gravity]."
    ] = None,
    free: Annotated[
        float | None,
        "In place of a whirl: the natural sloshing wave whose crest is so many mean depths deep (linear, "
        "potential).",
    ] = None,
    mode: Annotated[int | None, "Crests of the natural sloshing wave [default: 1]."] = None,
    model: Annotated[
        str, "statics, linear, long_wave, kdv, fem or potential; auto: the cheapest within the tolerance."
    ] = "linear",
    tolerance: Annotated[
        float | None, "Error of the force, relative, that is allowed to auto [default: 0.01]."
    ] = None,
    cells: Annotated[
        int | None,
        "Cells round the wall [default: long_wave 256, fem 96]; "
        "most nodes from crest to trough, in time round the wall [default: potential 432, 2048].",
    ] = None,
    baffles: Annotated[int, "Number of radial baffles (fem)."] = 0,
    baffle_tip_radius: Annotated[
        Quantity, LENGTH, "Distance of the baffles' inner edges from the axis; 0: through the surface."
    ] = 0.0,
    baffle_wall_gap: Annotated[Quantity, LENGTH, "Distance of the baffles' outer edges from the wall."] = 0.0,
    dispersion: Annotated[
        bool, Option(("--dispersion",)), "Exact linear dispersion (long_wave, kdv)."
    ] = False,
    friction: Annotated[
        Any,
        FRICTION,
        "none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER [default: the machine's, none].",
    ] = None,
    gravity: Annotated[
        Quantity | None, ACCELERATION, "Gravity across the axis [default: the machine's, 0]."
    ] = None,
    liquid: Annotated[Any, LIQUID, "Name of the liquid [default: the machine's, water]."] = None,
    duration: Annotated[
        Quantity | None, TIME, "Start from rest and answer period by period (long_wave, potential)."
    ] = None,
    ramp: Annotated[Quantity, TIME, "Time over which the whirl grows, with a duration."] = 0.0,
    solver: Annotated[
        str | None,
        "Solver of py-pde: runge-kutta, scipy ... [default: long_wave finite_volume, kdv steady_newton].",
    ] = None,
) -> AnyLayerAnswer:
    """Force and centre of mass of a liquid layer under a prescribed whirl, in the plane; or its natural wave.

    A natural sloshing wave runs round the drum without a whirl; the answer is its speed. Friction is a text,
    a table as in a machine file ({"linear": 0.5}) or a `Friction`; a liquid a known name or a `Liquid`.
    Of a machine the chamber, baffles, liquid, law of friction and, where its axis lies, gravity are taken.

    Raises
    ------
    InputError : a value out of its range, or one that the model does not serve

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.layer(radius="150 mm", volume="671 ml", height="50 mm", speed=40.0, whirl_speed=32.0,
    ...                  whirl_amplitude="0.15 mm")
    >>> found.converged
    True
    >>> lb.layer(lb.example("horizontal_rig"), whirl_speed="1000 rpm", whirl_amplitude="0.1 mm").case.radius
    0.065
    """
    return ask(layer, "leblanc.studies.layer.study:answer", locals())


def present(
    answer: Any,
    *,
    profile: Annotated[bool, Option(("--profile",)), "Add the depth around the wall."] = False,
    animate: Annotated[
        Any,
        _FILM,
        "GIF or MP4 of the wave in the drum frame: long_wave from rest, potential with --duration too, "
        "others steady.",
    ] = None,
) -> AnyLayerAnswer:
    """What the command alone is asked for: with the depth around the wall or without, and a film."""
    shown: AnyLayerAnswer = called("leblanc.studies.layer.study:present")(answer, profile, animate)
    return shown
