"""Charts of stability over two parameters: where balls keep a rotor balanced, and the curves where that ends.

On such a curve a root stands on the imaginary axis: a pair of them, where the balls begin to swing or the
rotor to whirl (Hopf), or one at 0, where steady states meet or part (a fold or a branching).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex, Indices
from meshes.errors import InputError
from solvers.continuation import Curve, End, follow
from solvers.roots import bracketed_root
from solvers.rotor.balls.balancers import BallRace, race_arrays
from solvers.rotor.balls.stability import linearised
from solvers.rotor.balls.states import balanced_places, steady_places, turning_deflection
from solvers.rotor.system import RotorSystem

NONE = -1  # in counts of growing roots: the state is not there
_HALVINGS = 40
_NEAR = 0.03  # of a cell of the chart: a crossing this close to a known curve lies on it
_STILL = 1e-6  # of the spin: a root slower than that is real


@dataclass(frozen=True)
class Machine:
    """A rotor with balls that turns at a speed.

    Parameters
    ----------
    system : the same in every direction across its axis
    races : one or more
    speed : Omega, rad/s
    """

    system: RotorSystem
    races: tuple[BallRace, ...]
    speed: float


Family = Callable[[float, float], Machine]  # the machine that belongs to a point of the chart


class Crossing(Enum):
    """What stands on the imaginary axis."""

    HOPF = "a pair of roots"
    ZERO = "one root at 0"


@dataclass(frozen=True)
class Edge:
    """A curve on which a root stands on the imaginary axis; k points.

    Parameters
    ----------
    kind : a pair of roots, or one at 0
    first, second : the two parameters, shape (k,)
    frequency : of the pair as seen from the rotor, rad/s, shape (k,)
    ends : why it ends, at its first and at its last point
    """

    kind: Crossing
    first: Array
    second: Array
    frequency: Array
    ends: tuple[End, End]


@dataclass(frozen=True)
class Chart:
    """Stability over two parameters; a values of the first, b of the second.

    Parameters
    ----------
    first, second : rising values, shape (a,) and (b,)
    growing : number of roots with a positive real part, neutral directions left out; `NONE` where the state
        does not exist, shape (a, b)
    growth : largest real part, 1/s; nan where the state does not exist, shape (a, b)
    edges : curves on which the number of growing roots changes
    """

    first: Array
    second: Array
    growing: Indices
    growth: Array
    edges: tuple[Edge, ...]


class State:
    """The state whose stability is charted: balanced, or next to given places of the balls.

    Parameters
    ----------
    places : of the balls near the state, rad, shape (N,); None for the balanced state
    """

    def __init__(self, places: ArrayLike | None = None) -> None:
        self.places = None if places is None else np.asarray(places, dtype=float)

    def matrix(self, machine: Machine) -> Array | None:
        """Rates of small disturbances, without neutral directions; None where there is no such state.

        Parameters
        ----------
        machine : at a point of the chart
        """
        system, races, speed = machine.system, machine.races, machine.speed
        if self.places is None:
            try:
                places = balanced_places(system, races)
            except InputError:
                return None
            return linearised(system, races, speed, places).matrix()
        found = steady_places(system, races, speed, self.places)
        if found is None or np.abs(np.angle(np.exp(1j * (found - self.places)))).max() > 0.5 * np.pi:
            return None
        deflection = turning_deflection(system, races, speed, found)
        return linearised(system, races, speed, found, deflection).matrix()


def gathered(system: RotorSystem, races: Sequence[BallRace], light: bool = False) -> State:
    """The state with the balls of each race together, next to the heavy side of its plane or opposite to it.

    The heavy side is where the unbalance bends the slowly turning rotor to. The state itself is sought anew
    at each point of a chart.

    Parameters
    ----------
    system, races : rotor and balls
    light : opposite
    """
    axes, _ = race_arrays(system, races)
    bent = np.linalg.solve(system.stiffness, system.unbalance)
    forward = (axes[:, 0] + 1j * axes[:, 1]) @ bent
    return State(np.angle(forward) + (np.pi if light else 0.0))


def stability_chart(family: Family, first: ArrayLike, second: ArrayLike, state: State | None = None) -> Chart:
    """Count growing roots on a grid, and follow every curve on which the count changes.

    A curve that passes between the lines of the grid is not seen; one that is seen is followed to its end
    or to the edge of the grid.

    Parameters
    ----------
    family : machine for each pair of values
    first, second : values of the grid, rising, two or more each
    state : whose stability; None: the balanced one

    Raises
    ------
    InputError : values that do not rise
    """
    x, y = (np.asarray(values, dtype=float) for values in (first, second))
    for name, values in (("first", x), ("second", y)):
        if values.ndim != 1 or values.size < 2 or not np.all(np.diff(values) > 0.0):
            raise InputError(name, values.tolist(), "two or more values that rise")
    chosen = state or State()
    growing = np.full((x.size, y.size), NONE, dtype=np.int64)
    growth = np.full((x.size, y.size), np.nan)
    for i, a in enumerate(x.tolist()):
        for j, b in enumerate(y.tolist()):
            growing[i, j], growth[i, j] = _counted(chosen, family(a, b))
    edges: list[Edge] = []
    cell = np.array([(x[-1] - x[0]) / (x.size - 1), (y[-1] - y[0]) / (y.size - 1)])
    low, high = np.array([x[0], y[0]]), np.array([x[-1], y[-1]])
    for inside, outside in _changes(x, y, growing):
        where, root = _crossing(chosen, family, inside, outside)
        if root is None or any(_on(edge, where, cell) for edge in edges):
            continue
        edge = follow_edge(family, where, root, low, high, chosen)
        if edge is not None:
            edges.append(edge)
    return Chart(x, y, growing, growth, tuple(edges))


def stable_bands(
    family: Family, first: ArrayLike, second: float, state: State | None = None
) -> tuple[Array, list[tuple[float, float]]]:
    """Growth over the first parameter at one value of the second, and the bands of it without growth.

    Parameters
    ----------
    family : machine for each pair of values
    first : values that rise, shape (a,)
    second : the other parameter
    state : whose stability; None: the balanced one

    Returns
    -------
    growth : largest real part, 1/s; nan where the state does not exist, shape (a,)
    bands : ends of each; between two values they are where the growth changes its sign, to rounding
    """
    x, chosen = np.asarray(first, dtype=float), state or State()

    def largest(at: Array, _: Indices) -> Array:
        return np.array([_counted(chosen, family(float(value), second))[1] for value in at])

    growth = largest(x, np.zeros(0, dtype=np.int64))
    stable = growth <= 0.0
    changes = np.flatnonzero(stable[1:] != stable[:-1])
    # Where the state ends there is no sign to change: the last value that has it stands.
    known = changes[np.isfinite(growth[changes]) & np.isfinite(growth[changes + 1])]
    ends = {k: float(x[k] if stable[k] else x[k + 1]) for k in changes.tolist()}
    if known.size:
        found = bracketed_root(largest, x[known], x[known + 1])[0]
        ends |= dict(zip(known.tolist(), found.tolist(), strict=True))
    edges = [ends[k] for k in changes.tolist()]
    edges = ([float(x[0])] if stable[0] else []) + edges + ([float(x[-1])] if stable[-1] else [])
    return growth, list(zip(edges[::2], edges[1::2], strict=True))


def existence_bounds(
    family: Family, first: float, second: ArrayLike, state: State | None = None
) -> list[float]:
    """Values of the second parameter between which the state begins or ends to exist, by halving.

    Parameters
    ----------
    family : machine for each pair of values
    first : one value of the first parameter; the balanced state exists at all speeds or at none
    second : values that rise, shape (b,)
    state : None: the balanced one
    """
    y, chosen = np.asarray(second, dtype=float), state or State()

    def exists(at: float) -> bool:
        return chosen.matrix(family(first, at)) is not None

    there, found = [exists(at) for at in y.tolist()], []
    for k in [k for k in range(y.size - 1) if there[k] != there[k + 1]]:
        low, high = float(y[k]), float(y[k + 1])
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if exists(middle) == there[k] else (low, middle)
        found.append(0.5 * (low + high))
    return found


def follow_edge(
    family: Family,
    where: ArrayLike,
    root: complex,
    low: ArrayLike,
    high: ArrayLike,
    state: State | None = None,
) -> Edge | None:
    """Follow the curve on which a root stays on the imaginary axis, both ways [theory: balls, eq. 39].

    Parameters
    ----------
    family : machine for each pair of values
    where : the two values near the curve, shape (2,)
    root : there, 1/s, near the imaginary axis
    low, high : corners of the rectangle of values, shape (2,)
    state : whose stability; None: the balanced one

    Returns
    -------
    Edge, its points from one end to the other; None where no curve is found next to the start
    """
    corner, far = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    at, span = np.asarray(where, dtype=float), far - corner
    speed = family(*at.tolist()).speed
    swings = abs(root.imag) > _STILL * speed
    test = _Bordered(family, state or State(), swings)
    start = np.append(at, abs(root.imag)) if swings else at
    test.renew(start)
    unit = np.append(span, speed) if swings else span
    box = (np.append(corner, 0.0), np.append(far, np.inf)) if swings else (corner, far)
    ways = []
    for way in (1, -1):
        test.renew(start)
        ways.append(follow(test, start, unit, *box, step=0.02, way=way, renew=test.renew))
        if ways[-1].end is End.CLOSED:
            break
    if all(len(curve.points) < 2 for curve in ways):
        return None
    return _joined(ways, Crossing.HOPF if swings else Crossing.ZERO)


def _joined(ways: Sequence[Curve], kind: Crossing) -> Edge:
    """One curve of the two ways from its start."""
    points = ways[0].points
    ends = ways[0].end, ways[0].end
    if len(ways) == 2:
        points = np.concatenate((ways[1].points[:0:-1], ways[0].points))
        ends = ways[1].end, ways[0].end
    frequency = points[:, 2] if kind is Crossing.HOPF else np.zeros(len(points))
    return Edge(kind, points[:, 0], points[:, 1], frequency, ends)


class _Bordered:
    """The equation det(A - i w) = 0, made smooth and of order one by a border [theory: balls, eq. 39].

    Parameters
    ----------
    family, state : of the chart
    swings : a pair of roots; else one at 0
    """

    def __init__(self, family: Family, state: State, swings: bool) -> None:
        self.family, self.state, self.swings = family, state, swings
        self.left, self.right = np.zeros(0, dtype=complex), np.zeros(0, dtype=complex)

    def _shifted(self, point: Array) -> Complex | None:
        try:
            machine = self.family(float(point[0]), float(point[1]))
        except InputError:
            # A step may lead out of the chart, where values need not make a machine.
            return None
        matrix = self.state.matrix(machine)
        if matrix is None:
            return None
        shift = 1j * point[2] if self.swings else 0.0
        # Over the spin, and position against speed likewise: entries of one size.
        scale = np.ones(len(matrix))
        scale[: len(matrix) - machine.system.mass.shape[0] - _count(machine)] = machine.speed
        matrix = scale[:, None] * matrix / scale / machine.speed
        return np.asarray(matrix - shift / machine.speed * np.eye(len(matrix)), dtype=complex)

    def renew(self, point: Array) -> None:
        """Take the directions that A - i w maps to least as the border."""
        matrix = self._shifted(point)
        if matrix is not None:
            before, _, after = np.linalg.svd(matrix)
            self.left, self.right = before[:, -1], after[-1].conj()

    def __call__(self, point: Array) -> Array:
        matrix = self._shifted(point)
        size = self.left.size
        if matrix is None or len(matrix) != size:
            return np.full(point.size - 1, np.nan)
        whole = np.zeros((size + 1, size + 1), dtype=complex)
        whole[:size, :size], whole[:size, size], whole[size, :size] = matrix, self.left, self.right.conj()
        one = np.zeros(size + 1, dtype=complex)
        one[size] = 1.0
        left = np.linalg.solve(whole, one)[size]
        return np.array([left.real, left.imag]) if self.swings else np.array([left.real])


def _count(machine: Machine) -> int:
    return sum(len(race.masses) for race in machine.races)


def _roots(state: State, machine: Machine) -> Complex | None:
    matrix = state.matrix(machine)
    return None if matrix is None else np.asarray(np.linalg.eigvals(matrix), dtype=complex)


def _counted(state: State, machine: Machine) -> tuple[int, float]:
    """Growing roots, and the largest real part."""
    roots = _roots(state, machine)
    if roots is None:
        return NONE, np.nan
    return int(np.sum(roots.real > 0.0)), float(roots.real.max())


def _changes(x: Array, y: Array, growing: Indices) -> list[tuple[Array, Array]]:
    """Neighbours of the grid with different numbers of growing roots."""
    found = []
    for i, a in enumerate(x):
        for j, b in enumerate(y):
            for k, m in ((i + 1, j), (i, j + 1)):
                if k == x.size or m == y.size or NONE in (growing[i, j], growing[k, m]):
                    continue
                if growing[i, j] != growing[k, m]:
                    found.append((np.array([a, b]), np.array([x[k], y[m]])))
    return found


def _crossing(state: State, family: Family, inside: Array, outside: Array) -> tuple[Array, complex | None]:
    """Where between two points the number of growing roots first changes, and the root next to the axis."""
    wanted = _counted(state, family(*inside.tolist()))[0]
    low, high = inside, outside
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if _counted(state, family(*middle.tolist()))[0] == wanted:
            low = middle
        else:
            high = middle
    roots = _roots(state, family(*high.tolist()))
    if roots is None:
        return high, None
    return high, complex(roots[np.argmin(np.abs(roots.real))])


def _on(edge: Edge, where: Array, cell: Array) -> bool:
    """A point lies on a known curve: next to one of its pieces, measured in cells."""
    points = np.stack((edge.first, edge.second), axis=1) / cell
    at = where / cell
    begin, way = points[:-1], np.diff(points, axis=0)
    length = np.maximum(np.einsum("ka,ka->k", way, way), 1e-300)
    share = np.clip(np.einsum("ka,ka->k", at - begin, way) / length, 0.0, 1.0)
    return bool(np.hypot(*(begin + share[:, None] * way - at).T).min() < _NEAR)
