"""Stability charts over two parameters: where balls keep a rotor balanced, and the boundaries of that region.

On such a boundary a root is on the imaginary axis: a pair where balls swing or the rotor whirls (Hopf), or
one at 0 (a fold or a branching); on supports that differ a multiplier of half a turn on the unit circle.
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
from solvers.rotor.balls.stability import HalfTurn, Linearised, small_motions
from solvers.rotor.balls.states import RotorWithBalls, turning
from solvers.rotor.system import RotorSystem

NONE = -1  # in counts of growing roots: the state is not there, or its half turn did not settle
_HALVINGS = 40
_MEETS = 1e-5  # of the spin: a root below this next to the end of a state tells that two states meet there
_NEAR = 0.03  # of a cell of the chart: a crossing this close to a known curve lies on it
_STILL = 1e-6  # of the spin: a root slower than that is real
_LARGEST = 24  # matrix whose sums of roots are looked at: twice 276 of them
_PARABOLA = 1e-9  # of the largest entry: how well a parabola follows the matrix
_APART = 0.02  # relative distance of speeds where none does
_MEET = 1e-4  # of half a range: roots this near the real speeds count as there


@dataclass(frozen=True)
class Machine:
    """A rotor with balls that turns at a speed."""

    system: RotorSystem  #: any rotor
    races: tuple[BallRace, ...]  #: one or more
    speed: float  #: Omega, rad/s


Family = Callable[[float, float], Machine]  # the machine that belongs to a point of the chart


class Crossing(Enum):
    """Kind of root on the imaginary axis."""

    HOPF = "a pair of roots"
    ZERO = "one root at 0"


@dataclass(frozen=True)
class Edge:
    """Stability boundary, a curve on which a root is on the imaginary axis; k points."""

    kind: Crossing  #: a pair of roots, or one at 0
    first: Array  #: the two parameters, shape (k,)
    second: Array
    #: of the pair as seen from the rotor, rad/s, shape (k,). Where the supports differ it may be the spin
    #: itself: a single multiplier is then at -1
    frequency: Array
    ends: tuple[End, End]  #: why it ends, at its first and at its last point


@dataclass(frozen=True)
class Chart:
    """Stability over two parameters; a values of the first, b of the second."""

    first: Array  #: rising values, shape (a,) and (b,)
    second: Array
    #: number of roots with a positive real part, neutral directions left out; `NONE` where the state does not
    #: exist, shape (a, b)
    growing: Indices
    growth: Array  #: largest real part, 1/s; nan where the state does not exist, shape (a, b)
    #: curves on which the number of growing roots changes, or on which the state meets another and ends
    edges: tuple[Edge, ...]


@dataclass(frozen=True)
class Rest:
    """Balls at rest in a rotor."""

    machine: RotorWithBalls  #: rotor and balls
    speed: float  #: Omega, rad/s
    places: Array  #: of the balls in the rotor, rad, shape (N,)
    coordinates: Complex | None  #: complex amplitudes of the rotor, shape (n,); None where it is balanced

    def motions(self, steps: int | None = None) -> Linearised | HalfTurn:
        """Small motions about it, without neutral directions.

        Over half a turn where the supports differ, by so many steps; None: as many as needed.
        """
        return small_motions(self.machine, self.speed, self.places, self.coordinates, steps=steps)


class State:
    """State whose stability is charted: the balanced one (None), or one next to given places.

    Places in rad, shape (N,). Where the supports differ the balls follow the forward part of the rotor's
    motion [theory: races, eq. 5].
    """

    def __init__(self, places: ArrayLike | None = None) -> None:
        self.places = None if places is None else np.asarray(places, dtype=float)

    def at(self, machine: Machine, near: Array | None = None) -> Rest | None:
        """The state; None where there is none within a quarter turn of the places.

        The search begins at `near` in place of those places.
        """
        rotor = RotorWithBalls(machine.system, tuple(machine.races))
        if self.places is None:
            places = rotor.balanced()
            return None if places is None else Rest(rotor, machine.speed, places, None)
        begin = self.places if near is None else near
        found = rotor.nearest(rotor.compliance(np.array([machine.speed]))[0], begin)
        if found is None or np.abs(np.angle(np.exp(1j * (found - begin)))).max() > 0.5 * np.pi:
            return None
        return _held(rotor, machine.speed, found)[0]


def _held(rotor: RotorWithBalls, speed: float, places: Array) -> tuple[Rest, Array]:
    """Balls at these places, and the pulls on them, 0 if they rest there, over the largest possible."""
    compliance = rotor.compliance(np.array([speed]))
    pulls = rotor.pulls(compliance, places[None])[0][0]
    return Rest(rotor, speed, places, rotor.coordinates(compliance, places[None])[0]), pulls


def gathered(system: RotorSystem, races: Sequence[BallRace], light: bool = False) -> State:
    """The state with the balls of each race together, next to the heavy side of its plane or opposite to it.

    The heavy side is where the unbalance bends the slowly turning rotor to.
    """
    axes, _ = race_arrays(system, races)
    bent = np.linalg.solve(system.stiffness, system.unbalance)
    forward = (axes[:, 0] + 1j * axes[:, 1]) @ bent
    return State(np.angle(forward) + (np.pi if light else 0.0))


def stability_chart(family: Family, first: ArrayLike, second: ArrayLike, state: State | None = None) -> Chart:
    """Count unstable roots on a grid of two parameters, and follow every boundary between the counts.

    Both parameters rise. A boundary between the lines of the grid is not seen. Where a state with a
    deflection ends in a fold, that is a boundary as well.
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
    for inside, outside in _neighbours(x, y, growing):
        where, root = _crossing(chosen, family, inside, outside)
        if root is None or any(_on(edge, where, cell) for edge in edges):
            continue
        ends = chosen.at(family(*outside.tolist())) is None
        edge = follow_edge(family, where, root, low, high, chosen, fold=ends)
        # From a point that lies on none Newton's method may end on another curve.
        if edge is not None and _on(edge, where, cell):
            edges.append(edge)
    return Chart(x, y, growing, growth, tuple(edges))


def stable_bands(
    family: Family, first: ArrayLike, second: float, state: State | None = None
) -> tuple[Array, list[tuple[float, float]]]:
    """Growth rate over speed at one value of the second parameter, and the bands of speed that are stable.

    Growth rate in 1/s, nan where there is no state. The ends of the bands are sought at speeds of their own,
    so that none is lost between two of those given and none depends on their number
    [theory: balls, eq. 32-34].
    """
    asked, chosen = np.asarray(first, dtype=float), state or State()

    def largest(at: Array, _: Indices) -> Array:
        return np.array([_counted(chosen, family(float(value), second))[1] for value in at])

    none = np.zeros(0, dtype=np.int64)
    x = _looks(lambda speed: chosen.at(family(speed, second)), float(asked[0]), float(asked[-1]))
    growth = largest(x, none)
    stable = growth <= 0.0
    changes = np.flatnonzero(stable[1:] != stable[:-1])
    # Where the state ends there is no sign to change: its end is halved.
    known = changes[np.isfinite(growth[changes]) & np.isfinite(growth[changes + 1])]
    ends: dict[int, float] = {}
    for k in np.setdiff1d(changes, known).tolist():
        has, lacks = (x[k], x[k + 1]) if stable[k] else (x[k + 1], x[k])
        for _ in range(_HALVINGS):
            middle = 0.5 * (has + lacks)
            there = bool(largest(np.array([middle]), none)[0] <= 0.0)
            has, lacks = (middle, lacks) if there else (has, middle)
        ends[k] = float(has)
    if known.size:
        found = bracketed_root(largest, x[known], x[known + 1])[0]
        ends |= dict(zip(known.tolist(), found.tolist(), strict=True))
    edges = [ends[k] for k in changes.tolist()]
    edges = ([float(x[0])] if stable[0] else []) + edges + ([float(x[-1])] if stable[-1] else [])
    return largest(asked, none), list(zip(edges[::2], edges[1::2], strict=True))


def _looks(at: Callable[[float], Rest | None], first: float, last: float) -> Array:
    """Speeds, the ends among them, between which no more than one edge of a band lies.

    The matrix of small motions about balls that stay where they are is a parabola over the spin, so that all
    speeds with a root on the axis are its eigenvalues; elsewhere parabolas follow it over shorter ranges, or
    speeds are a fiftieth apart.
    """
    start = at(first)
    if start is not None and turning(start.machine.system) is None:
        # The map of half a turn is no parabola, and costs much.
        between = np.geomspace(first, last, 1 + int(np.ceil(np.log(last / first) / _APART)))[1:-1]
        return np.concatenate(([first], between, [last]))
    found, waiting = [first, last], [(first, last)]
    while waiting:
        low, high = waiting.pop()
        rests = [at(low + share * (high - low)) for share in (0.0, 0.25, 0.5, 0.75, 1.0)]
        motions = [rest.motions() for rest in rests if rest is not None]
        parts = [own.lasting(0.0, last).real for own in motions if isinstance(own, Linearised)]
        size = max((len(part) for part in parts), default=0)
        if len(parts) == 5 and all(len(part) == size for part in parts) and 0 < size <= _LARGEST:
            a, before, b, after, c = parts
            rise, bend = 0.5 * (c - a), 0.5 * (a + c) - b
            off = np.stack((before - b + 0.5 * rise - 0.25 * bend, after - b - 0.5 * rise - 0.25 * bend))
            if np.abs(off).max() <= _PARABOLA * np.abs(b).max():
                shares = np.concatenate(([-1.0], _on_axis(b, rise, bend), [1.0]))
                found += (low + 0.5 * (high - low) * (1.0 + 0.5 * (shares[1:] + shares[:-1]))).tolist()
                found += [low, high]
                continue
        if high - low <= _APART * high:
            found += [low, high]
            continue
        middle = 0.5 * (low + high)
        waiting += [(low, middle), (middle, high)]
    return np.unique(found)


def _on_axis(middle: Array, rise: Array, bend: Array) -> Array:
    """Rising t in (-1, 1) at which A = middle + t rise + t^2 bend has two roots of sum 0, or one at 0.

    Sums of two roots are the roots of what A makes of the areas x ^ y: A x ^ y + x ^ A y.
    """
    one, other = np.triu_indices(len(middle), 1)
    unit = np.eye(len(middle))

    def on_areas(matrix: Array) -> Array:
        terms = [(matrix, unit), (unit, matrix)]
        return np.asarray(
            sum(
                p[np.ix_(one, one)] * q[np.ix_(other, other)] - p[np.ix_(one, other)] * q[np.ix_(other, one)]
                for p, q in terms
            )
        )

    found = [np.zeros(0)]
    for parts in ((middle, rise, bend), tuple(on_areas(part) for part in (middle, rise, bend))):
        # With t = far + 1/y the roots y of y^2 A(far) + y A'(far) + bend are those of a plain matrix.
        far, size = -1.7, len(parts[0])
        whole = np.linalg.inv(parts[0] + far * parts[1] + far**2 * parts[2])
        companion = np.zeros((2 * size, 2 * size))
        companion[:size, size:] = np.eye(size)
        companion[size:, :size] = -whole @ parts[2]
        companion[size:, size:] = -whole @ (parts[1] + 2.0 * far * parts[2])
        root = np.linalg.eigvals(companion)
        root = far + 1.0 / root[np.abs(root) > 0.1]
        # Two that meet part by the square root of rounding.
        found.append(root.real[(np.abs(root.imag) <= _MEET) & (np.abs(root.real) < 1.0)])
    return np.unique(np.concatenate(found))


def existence_bounds(family: Family, first: float, second: ArrayLike) -> list[float]:
    """Values of the second parameter between which balance begins or ends to exist, by halving."""
    y = np.asarray(second, dtype=float)

    def exists(at: float) -> bool:
        return State().at(family(first, at)) is not None

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
    fold: bool = False,
) -> Edge | None:
    """Follow the curve on which a root stays on the imaginary axis, both ways [theory: balls, eq. 39].

    From `where`, shape (2,), with a root (1/s) near the axis there, within the corners `low` and `high`. At a
    `fold` the places of the balls are followed as well. None where no curve is found next to the start.
    """
    corner, far = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    at, span = np.asarray(where, dtype=float), far - corner
    speed, chosen = family(*at.tolist()).speed, state or State()
    rest = chosen.at(family(*at.tolist()))
    if rest is None:
        return None
    swings = not fold and abs(root.imag) > _STILL * speed
    start, unit, box = at, span, (corner, far)
    if swings:
        start, unit = np.append(at, abs(root.imag)), np.append(span, speed)
        box = np.append(corner, 0.0), np.append(far, np.inf)
    elif fold:
        endless = np.full(rest.places.size, np.inf)
        start, unit = np.append(at, rest.places), np.append(span, np.ones(endless.size))
        box = np.append(corner, -endless), np.append(far, endless)
    ways = []
    for way in (1, -1):
        test = _Bordered(family, chosen, swings, fold, rest.places)
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
    """A motion neither grows nor decays: det(A - i w) = 0 made smooth by a border [theory: balls, eq. 39].

    The frequency is the third unknown of a pair that `swings`; at a `fold` the places of the balls are
    unknowns as well, and the pulls on them equations. The largest growth rate would have kinks.
    """

    def __init__(self, family: Family, state: State, swings: bool, fold: bool, near: Array) -> None:
        self.family, self.state, self.swings, self.fold, self.near = family, state, swings, fold, near
        self.left, self.right = np.zeros(0, dtype=complex), np.zeros(0, dtype=complex)
        # Fixed between two points of the curve: another number of steps is another function.
        self.steps: int | None = None
        # Speed and small motions next to the last point, by the two parameters: the frequency leaves them.
        self._known: dict[tuple[float, float], tuple[float, Linearised | HalfTurn]] = {}

    def _rest(self, point: Array) -> tuple[Rest, Array] | None:
        """The state, and the pulls that are left on its balls where their places are unknowns."""
        try:
            machine = self.family(float(point[0]), float(point[1]))
        except InputError:
            # A step may lead out of the chart, where values need not make a machine, or one at rest.
            return None
        if not machine.speed > 0.0:
            return None
        if self.fold:
            rotor = RotorWithBalls(machine.system, tuple(machine.races))
            return _held(rotor, machine.speed, point[2:])
        rest = self.state.at(machine, None if self.state.places is None else self.near)
        return None if rest is None else (rest, np.zeros(0))

    def _matrix(self, point: Array) -> tuple[Complex, Array] | None:
        """The matrix that is singular on the curve, and the pulls that are left; None without a state."""
        if not self.swings:
            found = self._rest(point)
            return found and (found[0].motions(self.steps).lasting(0.0, found[0].speed), found[1])
        at = float(point[0]), float(point[1])
        if at not in self._known:
            found = self._rest(point)
            if found is None:
                return None
            self._known[at] = found[0].speed, found[0].motions(self.steps)
        speed, motions = self._known[at]
        return motions.lasting(float(point[2]), speed), np.zeros(0)

    def renew(self, point: Array) -> None:
        """Take the directions that the matrix maps to least as the border, and this state's places."""
        found = self._rest(point)
        if found is None:
            return
        rest, self.near = found[0], found[0].places
        motions = rest.motions()
        self.steps = motions.steps if isinstance(motions, HalfTurn) else None
        self._known.clear()
        before, _, after = np.linalg.svd(motions.lasting(float(point[2]) if self.swings else 0.0, rest.speed))
        self.left, self.right = before[:, -1], after[-1].conj()

    def __call__(self, point: Array) -> Array:
        found, size = self._matrix(point), self.left.size
        if found is None or len(found[0]) != size:
            return np.full(point.size - 1, np.nan)
        matrix, pulls = found
        whole = np.zeros((size + 1, size + 1), dtype=complex)
        whole[:size, :size], whole[:size, size], whole[size, :size] = matrix, self.left, self.right.conj()
        unit = np.zeros(size + 1, dtype=complex)
        unit[size] = 1.0
        left = np.linalg.solve(whole, unit)[size]
        return np.array([*pulls, left.real, *([left.imag] if self.swings else [])])


def _roots(state: State, machine: Machine) -> Complex | None:
    """Roots of the state; None where it does not exist, or where half a turn did not converge."""
    rest = state.at(machine)
    motions = None if rest is None else rest.motions()
    return None if motions is None or not motions.settled else motions.roots()


def _counted(state: State, machine: Machine) -> tuple[int, float]:
    """Number of roots that grow, and the largest real part."""
    roots = _roots(state, machine)
    if roots is None:
        return NONE, np.nan
    return int(np.sum(roots.real > 0.0)), float(roots.real.max())


def _neighbours(x: Array, y: Array, growing: Indices) -> list[tuple[Array, Array]]:
    """Pairs of the grid with different numbers of growing roots, one with the state first."""
    found = []
    for i, a in enumerate(x):
        for j, b in enumerate(y):
            for k, m in ((i + 1, j), (i, j + 1)):
                if k == x.size or m == y.size or growing[i, j] == growing[k, m]:
                    continue
                pair = np.array([a, b]), np.array([x[k], y[m]])
                found.append(pair if growing[i, j] != NONE else pair[::-1])
    return found


def _crossing(state: State, family: Family, inside: Array, outside: Array) -> tuple[Array, complex | None]:
    """Where between two points the number of growing roots first changes, and the root next to the axis.

    None where the state ends there without meeting another.
    """
    wanted, other = (_counted(state, family(*point.tolist()))[0] for point in (inside, outside))
    if other == NONE and state.places is None:
        return inside, None
    low, high = inside, outside
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        count = _counted(state, family(*middle.tolist()))[0]
        if count == wanted or (other == NONE and count != NONE):
            low = middle
        else:
            high = middle
    where = low if other == NONE else high
    machine = family(*where.tolist())
    roots = _roots(state, machine)
    if roots is None:
        return where, None
    if other != NONE:
        return where, complex(roots[np.argmin(np.abs(roots.real))])
    least = complex(roots[np.argmin(np.abs(roots))])
    return where, least if abs(least) <= _MEETS * machine.speed else None


def _on(edge: Edge, where: Array, cell: Array) -> bool:
    """A point lies on a known curve: next to one of its pieces, measured in cells."""
    points = np.stack((edge.first, edge.second), axis=1) / cell
    at = where / cell
    begin, way = points[:-1], np.diff(points, axis=0)
    length = np.maximum(np.einsum("ka,ka->k", way, way), 1e-300)
    share = np.clip(np.einsum("ka,ka->k", at - begin, way) / length, 0.0, 1.0)
    return bool(np.hypot(*(begin + share[:, None] * way - at).T).min() < _NEAR)
