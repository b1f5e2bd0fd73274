"""All commands of the net: what is typed, and what is needed for it."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass

from tests.net.scenes import SMALL, WRONG

ROTORS = (
    *("two_plane_rig", "tub", "horizontal_rig", "vertical_rig", "washing_machine", "weak_motor"),
    *("centrifuge", "runup"),
)
WHOLE = ("two_plane_rig", "vertical_rig", "centrifuge", "runup")  # run-ups held to their end
BALLS = ("balls", "balls_and_liquid")
DOCS = ("closed_baffles", "lobes", "smallest_scene")
COMMANDS = (
    *(
        "new",
        "explain",
        "run",
        "compare",
        "fit",
        "volume",
        "layer",
        "modes",
        "map",
        "runup",
        "optimise",
        "sweep",
    ),
    *("trade", "view", "validate", "notebooks", "bearing"),
)


@dataclass(frozen=True)
class Case:
    """One command.

    Parameters
    ----------
    name : of the file that keeps its answer
    argv : what is typed behind `leblanc`
    needs : "screen" where pictures are drawn in three dimensions
    measured : keys of its JSON that a machine measures, held by type
    """

    name: str
    argv: tuple[str, ...]
    needs: str = ""
    measured: frozenset[str] = frozenset()


def all_cases() -> list[Case]:
    """Every command, those that take long first."""
    slow = _long, _runs, _comparisons, _runups, _optimums, _maps, _sweeps
    fast = _layers, _modes, _views, _words, _cheap, _wrong
    found = [case for part in (*slow, *fast) for case in part()]
    names = [case.name for case in found]
    assert len(set(names)) == len(names), "two commands of one name"
    return found


def missing(need: str) -> str | None:
    """What this machine lacks of a need, None if nothing."""
    if need == "screen" and not _loads("libEGL.so.1"):
        return "no libEGL"
    return None


def _loads(library: str) -> bool:
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


def _case(name: str, typed: str, **more: object) -> Case:
    return Case(name, tuple(typed.split()), **more)  # type: ignore[arg-type]


def _scene(name: str) -> str:
    return f"docs/examples/{name}.toml" if name in DOCS else f"examples/{name}.toml"


def _long() -> Iterator[Case]:
    measured = "time spread first memory time_ratio repeats default_overhead default_dominated_by on_front"
    yield _case(
        "trade-smallest_scene",
        "trade docs/examples/smallest_scene.toml --quick --repeats 2 --json --out out",
        measured=frozenset([*measured.split(), "recommended"]),
    )
    for group in (
        *("two_plane", "whirl", "layer", "runup", "fill_sweep", "exciter", "errata", "optimal_volume"),
        *("vector_model", "horizontal_rig", "vertical_rig", "tub", "baffles", "exact_wave", "claims"),
        *("blood_pump", "spindle", "turning", "measured_balls", "bearings", "kdv", "published", "lying_drum"),
    ):
        yield _case(f"validate-{group}", f"validate {group} --json")


def _runs() -> Iterator[Case]:
    for name in ("vibratory_table", "blood_pump", *ROTORS, *DOCS):
        scene = f"small/{name}.toml" if name in ("tub", "vertical_rig") else _scene(name)
        yield _case(f"run-{name}", f"run {scene} --json --out out")
        yield _case(f"explain-{name}", f"explain {scene} --json")
    yield _case("explain-top_loader", f"explain {_scene('top_loader')} --json")
    for name in BALLS:
        yield _case(f"run-{name}", f"run {_scene(name)} --json --out out")
        yield _case(f"explain-{name}", f"explain {_scene(name)} --json")
    yield _case("words-explain-balls", f"explain {_scene('balls')}")
    for command in ("run", "explain"):
        typed = f"{command} {_scene('measured_balls')} --json"
        yield _case(f"{command}-measured_balls", typed + " --out out" * (command == "run"))
    for name in ("tub_balls", "linear_balls"):
        yield _case(f"run-{name}", f"run small/{name}.toml --json --out out")
    yield _case("run-exact", "run small/horizontal_rig_exact.toml --workers 1 --json --out out")
    yield _case("run-spindle", f"run {_scene('spindle')} --json --out out")
    yield _case("run-top_loader", f"run {_scene('top_loader')} --json --out out")
    yield _case("explain-spinning_top", "explain docs/examples/spinning_top.toml --json")


def _comparisons() -> Iterator[Case]:
    cost = frozenset({"cpu_time"})
    for name, models in (("horizontal_rig", "kdv,linear,fem,statics"), ("centrifuge", "linear,statics,auto")):
        typed = f"compare {_scene(name)} --models {models} --json --out out"
        yield _case(f"compare-{name}", typed, measured=cost)


def _runups() -> Iterator[Case]:
    pieces = {name: f"small/{name}.toml" for name in SMALL if name.endswith(("_fallen", "_caught", "_above"))}
    for name, scene in (pieces | {name: _scene(name) for name in WHOLE}).items():
        yield _case(f"runup-{name}", f"runup {scene} --cells 32 --samples 201 --no-check --json --out out")
    typed = f"runup {_scene('programme')} --cells 16 --samples 401 --no-check --json --out out"
    yield _case("runup-programme", typed)
    typed = f"runup {_scene('top_loader')} --cells 32 --samples 401 --no-check --json --out out"
    yield _case("runup-top_loader", typed)
    for name in BALLS:
        yield _case(
            f"runup-{name}", f"runup {_scene(name)} --cells 32 --samples 201 --no-check --json --out out"
        )
    for name in ("tub_balls", "linear_balls"):
        yield _case(
            f"runup-{name}", f"runup small/{name}.toml --cells 16 --samples 101 --no-check --json --out out"
        )
    yield _case("runup-check", "runup small/runup.toml --samples 51 --json --out out")


def _optimums() -> Iterator[Case]:
    for name in (*ROTORS, *DOCS):
        yield _case(f"optimise-{name}", f"optimise {_scene(name)} --no-front --json --out out")
    for objective in ("peak", "mean", "least_mass", "robust"):
        yield _case(
            f"optimise-{objective}",
            f"optimise small/horizontal_rig.toml --objective {objective} --steady --no-front --json",
        )
    yield _case("optimise-balls", f"optimise {_scene('balls_design')} --json --out out")
    yield _case("words-optimise-balls", f"optimise {_scene('balls_design')} --out out")
    yield _case("optimise-layout", "optimise examples/tub.toml --objective layout --json --out out")
    typed = "optimise examples/tub.toml --objective floor_force --no-front --json --out out"
    yield _case("optimise-floor_force", typed)
    yield _case("optimise-front", "optimise small/centrifuge.toml --json --out out")
    limits = "--deflection 1mm --objective least_mass --limit 1.5mm"
    yield _case("optimise-deflection", f"optimise small/centrifuge.toml {limits} --json --out out")


_GRID = "--volumes 5 --speeds 11"


def _maps() -> Iterator[Case]:
    for name in (*ROTORS, *DOCS):
        yield _case(f"map-{name}", f"map {_scene(name)} {_GRID} --json --out out")
    friction = "--friction linear:0.5 --max-volume 20ml"
    yield _case("map-friction", f"map small/horizontal_rig.toml {_GRID} {friction} --json --out out")
    for name in (*BALLS, "long_rotor"):
        grid = "--values 5 --speeds 7"
        yield _case(f"map-{name}", f"map {_scene(name)} {grid} --json --out out")
    typed = (
        f"map {_scene('balls')} --over rotor.unbalance --to 1e-3 --state light --values 5 --speeds 7 --json"
    )
    yield _case("map-balls_light", f"{typed} --out out")
    wall = "--friction wall --max-volume 20ml"
    # Where on a branch its points lie hangs on the steps of the continuation: folds are held, points by type.
    cycles = "amplitude branch growth in_range lag power speed stable thinnest torque whirl_speed"
    yield _case(
        "map-cycles",
        "map docs/examples/self_excited.toml --cycles --volumes 3 --speeds 11 --json --out out",
        measured=frozenset(["cycles", *(f"cycle_{name}" for name in cycles.split())]),
    )
    yield _case(
        "map-cycles-kdv",
        "map docs/examples/self_excited.toml --cycles --model kdv --volumes 3 --speeds 11 --json --out out",
        measured=frozenset(["cycles", *(f"cycle_{name}" for name in cycles.split())]),
    )
    yield _case("map-wall", f"map small/horizontal_rig.toml {_GRID} {wall} --json --out out")


def _sweeps() -> Iterator[Case]:
    for study in ("fill_grid", "uncertain_rig", "centrifuge_shares"):
        more = " --netcdf --emulate" if study == "uncertain_rig" else ""
        yield _case(f"sweep-{study}", f"sweep small/{study}.toml --workers 0{more} --json --out out")
    yield _case("sweep-runups", "sweep small/uncertain_runup.toml --workers 0 --json --out out")
    yield _case("sweep-balls", "sweep small/balls_grid.toml --workers 0 --json --out out")
    fills = "--vary chambers.0.volume=2ml..20ml:4 --workers 0"
    yield _case("sweep-vary", f"sweep small/horizontal_rig.toml {fills} --json --out out")
    yield _case("words-sweep-vary", f"sweep small/horizontal_rig.toml {fills} --out out")
    yield _case("sweep-workers", "sweep small/centrifuge_shares.toml --workers 1 --json --out out")


_LAYER = "layer --radius 0.15 --volume 6.7e-4 --height 0.05 --speed 40 --whirl-speed 32 --whirl-amplitude"
_WHIRL = f"{_LAYER} 1.5e-4"
_FREE = f"{_LAYER.partition(' --whirl-speed')[0]} --free"
_DRUM = _LAYER.replace("--whirl-speed 32", "--whirl-speed 40")  # at rest in the drum


def _layers() -> Iterator[Case]:
    steady = {
        "statics": f"{_DRUM} 1.5e-4 --model statics",
        "statics-dry": f"{_DRUM} 4e-2 --model statics",
        "linear": f"{_WHIRL} --model linear",
        "linear-large": f"{_LAYER} 1.5e-2 --model linear",
        "brine": f"{_WHIRL} --model linear --liquid brine",
        "kdv": f"{_WHIRL} --model kdv",
        "kdv-stokes": f"{_WHIRL} --model kdv --friction stokes",
        "kdv-wall": f"{_WHIRL} --model kdv --friction wall",
        "kdv-linear": f"{_WHIRL} --model kdv --friction linear:0.5",
        "kdv-large": f"{_LAYER} 1.5e-2 --model kdv --friction linear:0.5",
        "kdv-dispersion": f"{_WHIRL} --model kdv --friction linear:0.5 --dispersion",
        "auto": f"{_WHIRL} --model auto",
        "auto-resonance": f"{_LAYER} 1.5e-3 --model auto --cells 64",
        "potential": f"{_WHIRL} --model potential",
        "potential-chokes": f"{_LAYER} 1.5e-3 --model potential",
        "potential-duration": f"{_WHIRL} --model potential --cells 128 --duration 2 --ramp 1",
        "free": f"{_FREE} 1.2 --model potential",
        "free-mode": f"{_FREE} 1.1 --model potential --mode 3",
        "free-linear": f"{_FREE} 1.2 --model linear",
        "fem": f"{_WHIRL} --model fem",
        "fem-closed": f"{_WHIRL} --model fem --baffles 6",
        "fem-baffles": f"{_WHIRL} --model fem --baffles 3 --baffle-tip-radius 140mm --baffle-wall-gap 2mm",
    }
    wave = f"{_WHIRL} --model long_wave --cells 64 --friction"
    steady |= {f"long_wave-{law.partition(':')[0]}": f"{wave} {law}" for law in _FRICTION}
    steady |= {
        "long_wave-gravity": f"{wave} linear:0.5 --gravity 9.81",
        "long_wave-dispersion": f"{wave} linear:0.5 --dispersion",
        "long_wave-smeared": f"{wave} linear:0.5 --baffles 20 --baffle-tip-radius 147mm",
    }
    stock = "--friction linear:3 --solver runge-kutta"
    steady |= {
        "kdv-runge-kutta": f"{_WHIRL} --model kdv --cells 16 {stock}",
        "long_wave-runge-kutta": f"{_WHIRL} --model long_wave --cells 16 {stock} --duration 2 --ramp 1",
    }
    starts = {f"duration-{law.partition(':')[0]}": f"{wave} {law} --duration 5 --ramp 1" for law in _FRICTION}
    starts["duration-bore"] = f"{_LAYER} 3e-3 --model long_wave --cells 64 --duration 2"
    for name, typed in (steady | starts).items():
        yield _case(f"layer-{name}", f"{typed} --profile --json")
    yield _case("layer-figure", f"{_WHIRL} --model linear --json --out out")


_FRICTION = ("none", "stokes", "linear:0.5", "quadratic:0.01", "wall:2e-6")
_MODES = "modes --radius 0.15 --volume 6.7e-4 --height 0.05 --speed 40"


def _modes() -> Iterator[Case]:
    yield _case("modes-round", f"{_MODES} --json --out out")
    yield _case("modes-order1", f"{_MODES} --order 1 --count 6 --segments 64 --layers 4 --json")
    yield _case("modes-closed", f"{_MODES} --baffles 6 --json")
    edges = "--baffle-tip-radius 140mm --baffle-wall-gap 2mm"
    yield _case("modes-baffles", f"{_MODES} --baffles 4 {edges} --json")
    lobes = "modes --radius 180mm --volume 1l --height 60mm --speed 60 --mesh docs/examples/lobes.msh"
    yield _case("modes-mesh", f"{lobes} --json --out out")
    yield _case("modes-words", f"{_MODES} --count 4")


def _views() -> Iterator[Case]:
    for name in ("vibratory_table", *BALLS, "long_rotor", *ROTORS, *DOCS):
        yield _case(f"view-{name}", f"view {_scene(name)} --json --out out", needs="screen")
    yield _case("view-blood_pump", f"view {_scene('blood_pump')} --json --out out", needs="screen")
    yield _case("view-spindle", f"view {_scene('spindle')} --mode 2 --json --out out", needs="screen")
    yield _case(
        "view-mode",
        "view examples/centrifuge.toml --mode 1 --screenshot mode.png --json --out out",
        needs="screen",
    )
    yield _case(
        "view-film",
        "view small/centrifuge.toml --animate film.gif --frames 3 --json --out out",
        needs="screen",
    )


def _words() -> Iterator[Case]:
    """Each command in words: exit code and files only."""
    for name in ("explain", "run", "runup", "optimise", "map"):
        options = {"map": " --volumes 3 --speeds 5", "optimise": " --no-front --steady"}.get(name, "")
        out = "" if name == "explain" else " --out out"
        yield _case(f"words-{name}", f"{name} small/runup.toml{options}{out}")
    yield _case("words-exciter", "run examples/vibratory_table.toml")
    yield _case("words-spindle", "run examples/spindle.toml")
    yield _case("words-bearing", f"{_BEARING} --cage 12Hz")
    yield _case("words-exciter-explain", "explain examples/vibratory_table.toml")
    yield _case("words-magnetic-explain", "explain examples/blood_pump.toml")
    yield _case("words-balls", f"run {_scene('balls')} --out out")
    yield _case("words-compare", "compare small/runup.toml --models linear,statics --out out")
    fitted = f"fit {_scene('horizontal_rig')} docs/examples/measured.csv --unknown rotor.mass --starts 2"
    yield _case("words-fit", f"{fitted} --out out")
    yield _case("fit", f"{fitted} --unknown rotor.damping_ratio --json --out out")
    angles = f"fit {_scene('horizontal_rig')} docs/examples/rig_angles.csv --unknown rotor.damping_ratio"
    yield _case("fit-angles", f"{angles} --unknown rotor.critical_speed --starts 1 --json --out out")
    added = f"fit {_scene('runup')} docs/examples/added.csv --unknown rotor.unbalance --starts 1"
    yield _case("fit-added", f"{added} --json --out out")
    yield _case("fit-each", f"{fitted} --scale each --json --out out")
    yield _case("words-volume", f"{_VOLUME} --volume 2e-4")
    yield _case("words-layer", f"{_WHIRL} --model linear")
    yield _case(
        "layer-machine",
        f"layer {_scene('horizontal_rig')} --chamber 2 --whirl-speed 1000rpm --whirl-amplitude 0.1mm --json",
    )
    yield _case("outputs-run", "outputs run --json")
    yield _case("export-csv", "export small/runup.toml --to csv --decimal comma --out out --json")
    yield _case("export-statespace", f"export {_scene('centrifuge')} --to statespace --out out --json")
    yield _case("words-export", f"export {_scene('centrifuge')} --to statespace --out out")
    yield _case("words-layer-duration", f"{_WHIRL} --model long_wave --cells 32 --duration 2")
    yield _case("words-sweep", "sweep small/centrifuge_shares.toml --workers 0")
    yield _case("words-view", "view small/runup.toml --screenshot view.png", needs="screen")
    yield _case("words-validate", "validate vector_model")
    yield _case("words-new", "new")
    yield _case("words-out", "run docs/examples/smallest_scene.toml")


_BEARING = "bearing --speed 33Hz --balls 9 --ball-diameter 7.144mm --pitch-diameter 31mm"
_VOLUME = "volume --radius 0.15 --height 0.05 --eccentricity 1e-3 --speed 100"


def _cheap() -> Iterator[Case]:
    volume = f"{_VOLUME} --json"
    yield _case("volume-optimal", volume)
    yield _case("volume-dry", f"{volume} --volume 2e-5")
    yield _case("volume-wet", f"{volume} --volume 2e-4")
    yield _case("volume-full", f"{volume} --volume 3.5e-3")
    yield _case("volume-slow", f"{volume} --volume 2e-4 --speed 12")
    yield _case("volume-ring", f"{volume} --volume 2e-4 --inner-radius 100mm --gravity 0")
    yield _case("bearing", f"{_BEARING} --contact-angle 15deg --cage 12Hz --json")
    ratios = "--ftf 0.38475 --bpfo 3.4555 --bpfi 5.5369 --bsf 2.0497"
    yield _case("bearing-fit", f"bearing --speed 33Hz {ratios} --json")
    yield _case("new-file", "new my_scene.toml")
    yield _case("help", "--help")
    for name in COMMANDS:
        yield _case(f"help-{name}", f"{name} --help")


def _wrong() -> Iterator[Case]:
    studies = ("unknown_path", "unknown_method", "unknown_spread", "no_samples")
    for name in (*WRONG, "empty", "not_text"):
        command = "sweep" if name in studies else "run"
        yield _case(f"wrong-{name}", f"{command} wrong/{name}.toml --json --out out")
    table, rig, smallest = _scene("vibratory_table"), _scene("horizontal_rig"), _scene("smallest_scene")
    pump = _scene("blood_pump")
    typed = {
        "no-file": "run nowhere.toml",
        "folder": "run examples",
        "explain-no-file": "explain nowhere.toml",
        "study-as-scene": "run examples/studies/uncertain_rig.toml",
        "scene-as-study": f"sweep {rig}",
        "vary-form": f"sweep {rig} --vary chambers.0.volume=2ml..20ml",
        "map-exciter": f"map {table}",
        "runup-exciter": f"runup {table}",
        "optimise-exciter": f"optimise {table}",
        "map-magnetic": f"map {pump}",
        "runup-magnetic": f"runup {pump}",
        "export-format": f"export {rig} --to ods",
        "export-gravity": f"export {rig} --to statespace",
        "optimise-magnetic": f"optimise {pump}",
        "compare-magnetic": f"compare {pump} --models statics",
        **{
            f"{name}-spindle": f"{name} {_scene('spindle')}"
            for name in ("explain", "map", "runup", "optimise", "trade")
        },
        "compare-spindle": f"compare {_scene('spindle')} --models statics",
        "bearing-nothing": "bearing --speed 33Hz",
        "bearing-balls": "bearing --speed 33Hz --ftf 0.4",
        "bearing-both": "bearing --speed 33Hz --ftf 0.4 --pitch-diameter 31mm",
        "compare-balls": f"compare {_scene('balls')} --models statics",
        "runup-missing": f"runup {smallest}",
        "map-over": f"map {_scene('balls')} --over rotor.beauty",
        "map-balls-volumes": f"map {_scene('balls')} --volumes 3",
        "map-values": f"map {rig} --values 3",
        "map-volumes": f"map {rig} --volumes 0",
        "map-friction": f"map {rig} --friction sticky",
        "compare-exciter": f"compare {table} --models statics",
        "compare-unknown": f"compare {rig} --models statics,beauty",
        "compare-twice": f"compare {rig} --models statics,statics",
        "compare-none": f"compare {_scene('closed_baffles')} --models kdv,statics",
        "optimise-objective": f"optimise {rig} --objective beauty",
        "optimise-seed": f"optimise {rig} --seed -1",
        "optimise-limit": f"optimise {rig} --objective least_mass --limit 1kg",
        "runup-cells": f"runup {rig} --cells 1",
        "volume-unit": "volume --radius 1kg --height 1 --eccentricity 1e-3 --speed 1",
        "volume-option": "volume --height 1",
        "volume-negative": "volume --radius 1 --height 1 --eccentricity -1e-3 --speed 1",
        "layer-model": f"{_WHIRL} --model best",
        "layer-friction": f"{_WHIRL} --friction linear:-1",
        "layer-duration": f"{_WHIRL} --model linear --duration 3",
        "layer-free-model": f"{_FREE} 1.2 --model kdv",
        "layer-free-whirl": f"{_WHIRL} --free 1.2",
        "layer-no-whirl": _FREE.removesuffix(" --free"),
        "layer-potential-gravity": f"{_WHIRL} --model potential --gravity 9.81",
        "layer-solver": f"{_WHIRL} --model long_wave --solver milstein",
        "layer-solver-model": f"{_WHIRL} --model linear --solver scipy",
        "layer-baffles": f"{_WHIRL} --model kdv --baffles 3",
        "layer-kdv-friction": f"{_WHIRL} --model kdv --friction quadratic:0.01",
        "layer-linear-friction": f"{_WHIRL} --model linear --friction stokes",
        "layer-statics-whirl": f"{_WHIRL} --model statics",
        "layer-number": f"{_LAYER} 1.5e-4e1",
        "layer-liquid": f"{_WHIRL} --liquid beer",
        "modes-mesh": f"{_MODES} --mesh nowhere.msh",
        "modes-mesh-unit": f"{_MODES} --mesh-unit mm",
        "modes-baffles": f"{_MODES} --baffles 99",
        "modes-count": f"{_MODES} --count 0",
        "view-ending": f"view {rig} --screenshot view.txt",
        "view-speed": f"view {rig} --speed 4kg",
        "view-frames": f"view {rig} --animate film.gif --frames 0",
        "view-together": f"view {rig} --browser --window",
        "new-there": "new docs/examples/smallest_scene.toml",
        "validate-group": "validate nothing",
        "notebooks-name": "notebooks nothing",
        "command": "nonsense",
        "option": f"run {rig} --speed 3",
        "out": f"run {smallest} --out docs/examples/smallest_scene.toml",
    }
    for name, line in typed.items():
        yield _case(f"wrong-{name}", line)
