"""Two shallow layers round the whole wall of a lying drum: a stream and a pool upon it, in time.

Unknowns of a cell: areas per radian A_1, A_2 and angular momenta L_1, L_2 of stream and pool, in the frame of
the chamber's axis, which does not turn [theory: pool, eq. 8-17]. Finite volumes of second order with the flux
of Rusanov for each layer; liquid at rest stays at rest, no area falls below zero; Heun's steps, with friction
and baffles implicit after them. Lengths over R, times in seconds.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid import pool as closures
from fluid.friction.laws import LINEAR, NONE, QUADRATIC, STOKES
from solvers.layer.drag import mean_rate
from solvers.layer.finite_volume import COMPILED
from solvers.layer.step import copy
from solvers.machine_code import BARE, machine_code

_jit: Any = machine_code(**COMPILED)
# A pool whose cells run dry makes much of how its parts round.
_part: Any = machine_code(settled=True, **(COMPILED | BARE))

_surface = _part(closures.surface_of)
_static = _part(closures.static_pressure)
_level = _part(closures.level_of)
_area_at = _part(closures.area_at)
_resistance = _part(closures.pool_resistance)

# Below this area (of R^2) there is nothing; the velocity of a film thinner than the root of this is faded.
DRY, _FADED = 2e-8, 4e-12
# A film thinner than this keeps no more momentum than its faded velocity has; a layer with less than this
# share of its cell has no velocity of its own.
_FILM, _NOTHING = 1e-3, 1e-9
# Courant number of the steps.
_COURANT = 0.4
# Liquid slower than this share of the speed at which its weight and its whirl are alike keeps its level.
_SLOW = 0.25
# Levels of two cells further apart than twice the depth of the shallower one are less and less one, by this
# share of the depth each.
_ALIKE = 0.25
# A pull weaker than this share of the whole holds no level.
_LEVEL = 0.02
_SLOPE_A, _SLOPE_W, _FORCE, _FLUX, _PULL, _EDGE = 0, 2, 4, 5, 9, 10
_TURN, _NEXT, _RATE, _FREE = 11, 13, 17, 21


@_part
def turnings(flow, full, spin, turn):
    """Angular velocity of the layers, rad/s, shape (2, n); films stick to the drum."""
    for i in range(turn.shape[1]):
        whole = flow[0, i] + flow[1, i]
        rest = 1.0 - min(whole, full)
        kept = whole * whole / (whole * whole + _FADED) if whole > DRY else 0.0
        mean = (flow[2, i] + flow[3, i]) / (rest * whole) if whole > DRY else 0.0
        for k in range(2):
            a = flow[k, i]
            w = flow[2 + k, i] / (rest * a) if a > _NOTHING * whole and whole > DRY else mean
            turn[k, i] = spin + kept * (w - spin)


@_part
def _limited(back, ahead):
    """Half of a cell's slope, by the monotonised central limiter."""
    if back * ahead <= 0.0:
        return 0.0
    least = min(abs(back), abs(ahead), 0.25 * abs(back + ahead))
    return least if back > 0.0 else -least


@_part
def _counted(flow, full, free):
    """Share of what brakes liquid that thins out off the wall, of forces `free` on cells, that counts.

    Weight is no pressure there. What is lifted where a stretch becomes thin comes down where it becomes deep:
    only what spreads on the whole would get energy for nothing, and is held back by as much.
    """
    lifted, lowered = 0.0, 0.0
    for i in range(flow.shape[1]):
        whole = flow[0, i] + flow[1, i]
        if whole > DRY:
            power = free[i] * (flow[2, i] + flow[3, i]) / (whole * (1.0 - min(whole, full)))
            lifted, lowered = lifted - min(power, 0.0), lowered + max(power, 0.0)
    return max(1.0 - lowered / (lifted + 1e-300), 0.0)


@_part
def _rates(flow, turn, x, y, angles, full, slot, rim, dt, work, rate):
    """Rates of change of a stage, and the fastest wave; outflow is cut to what a cell has in a time `dt`.

    `x`, `y`: body force over R, 1/s^2 [theory: pool, eq. 8-11].
    """
    n = flow.shape[1]
    step, fastest = 2.0 * np.pi / n, 0.0
    force, pull, free = work[_FORCE], work[_PULL], work[_FREE]
    weak = _LEVEL * np.sqrt(x * x + y * y) + 1e-300
    for i in range(n):
        before, after = (i - 1) % n, i + 1 if i < n - 1 else 0
        pull[i] = x * angles[0, i] + y * angles[1, i]
        force[i], free[i] = 0.0, 0.0
        for k in range(2):
            a = flow[k, i]
            work[_SLOPE_A + k, i] = _limited(a - flow[k, before], flow[k, after] - a)
            wet = a > DRY and flow[k, before] > DRY and flow[k, after] > DRY
            bend = _limited(turn[k, i] - turn[k, before], turn[k, after] - turn[k, i])
            work[_SLOPE_W + k, i] = bend if wet else 0.0
    for f in range(n):
        edge = x * angles[2, f] + y * angles[3, f]
        left = (f - 1) % n
        if flow[0, left] + flow[1, left] < DRY or flow[0, f] + flow[1, f] < DRY:
            # Beside a dry cell the higher bed counts.
            edge = min(pull[left], pull[f])
        # A film on a slope has a level of its own, unlike its neighbour's by more than it is deep.
        level_alike, apart, own_l, own_r = 1.0, 0.0, flow[0, left] + flow[1, left], flow[0, f] + flow[1, f]
        if own_l > DRY and own_r > DRY:
            r_l, r_r = _surface(own_l, full), _surface(own_r, full)
            apart = _level(own_l, r_l, pull[left], full, slot) - _level(own_r, r_r, pull[f], full, slot)
            much = abs(apart) / (min(own_l, own_r) * weak / _LEVEL)
            level_alike = max(1.0 - _ALIKE * max(much - 2.0, 0.0), 0.0)
        pressure, fast, stiff, slow = 0.0, 0.0, 0.0, 1.0
        mass_1, mass_2, jump_1, jump_2, swift, lower, both = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        held_l, held_r, share_l, share_r = 0.0, 0.0, 1.0, 1.0
        least_1, least_2, bend_1, bend_2 = 1.0, 1.0, 0.0, 0.0
        back_1, back_2, ahead_1, ahead_2 = 0.0, 0.0, 0.0, 0.0
        flows_1, flows_2, comes_1, comes_2 = 0.0, 0.0, 0.0, 0.0
        for side in range(2):
            i, way = (left, 1.0) if side == 0 else (f, -1.0)
            one, two = flow[0, i] + way * work[_SLOPE_A, i], flow[1, i] + way * work[_SLOPE_A + 1, i]
            w_1, w_2 = turn[0, i] + way * work[_SLOPE_W, i], turn[1, i] + way * work[_SLOPE_W + 1, i]
            whole, own = one + two, flow[0, i] + flow[1, i]
            square = (flow[0, i] * turn[0, i] ** 2 + flow[1, i] * turn[1, i] ** 2) / (own + 1e-300)
            r = _surface(own, full)
            # What fills the gap has the inner wall to lean on, under pressure.
            weighs = _static(r, pull[i]) + slot * max(own - full, 0.0)
            held = square * r + pull[i] > 0.0 or (own > full and weighs > 0.0)
            level = _level(own, r, pull[i], full, slot)
            share, dried, calm = 0.0, False, 0.0
            if own > DRY and pull[i] > weak:
                calm = max(2.0 * (1.0 - square * r / (_SLOW * pull[i])), 0.0)
            slow = min(slow, calm)
            if calm > 0.0:
                # Slow liquid keeps its level up to the face.
                share = level_alike * min(calm, 1.0)
                wanted = _area_at(level, edge, rim, full, slot) if edge > 0.0 else 0.0
                dried = wanted == 0.0
                stiff = max(stiff, min(calm, 1.0)) if max(own, wanted) > full else stiff
                whole += share * (wanted - whole)
                # The pool takes the change where there is one.
                one = min(one, whole) if flow[1, i] > DRY else whole
                two = whole - one
            radius = _surface(whole, full)
            rest = 1.0 - min(whole, full)
            mean = (one * w_1 * w_1 + two * w_2 * w_2) / (whole + 1e-300)
            wave = max(min(whole, full) * (mean + edge / radius), 0.0)
            beyond = max(whole - full, 0.0)
            wave = max(wave, slot) if max(whole, own) > full else wave
            celerity = np.sqrt(wave / rest)
            speed = max(abs(w_1) if one > DRY else 0.0, abs(w_2) if two > DRY else 0.0)
            swift, fast = max(swift, speed), max(fast, speed + celerity)
            lower += one
            both += whole
            still = _static(radius, edge) + slot * beyond
            stays = mean * radius + edge > 0.0 or (beyond > 0.0 and still > 0.0)
            still = still if stays else 0.0
            # What turns weighs on a free surface alone.
            turning = 0.5 * mean * whole**2 if beyond == 0.0 else 0.0
            pressure += 0.5 * (still + turning) if stays else 0.0
            # What is left of the pressure over the cell's own half once the weight on its slope is taken off.
            between = 0.5 * (min(whole, full) + min(own, full))
            if held and (stays or dried):
                drop = _level(whole, radius, edge, full, slot) - level
                drop = (1.0 - share) * drop if dried else drop
                balance = still + between * drop
            elif held:
                # Its pressure ends within the cell.
                balance = weighs + between * r * (edge - pull[i])
            else:
                balance = between * r * (edge - pull[i])
                free[i] += way * between * edge * (radius - r) / step
            # A cell that its level makes deep at a face has no more to move, or to be pushed.
            share = min(1.0, 2.0 * own / (whole + 1e-300))
            if side == 0:
                held_l, share_l = balance, share
            else:
                held_r, share_r = balance, share
            mass_1 += 0.5 * share * one * w_1
            mass_2 += 0.5 * share * two * w_2
            jump_1 -= way * one
            jump_2 -= way * two
            if side == 0:
                back_1, back_2 = rest * w_1, rest * w_2
                flows_1, flows_2 = share * one * max(w_1, 0.0), share * two * max(w_2, 0.0)
            else:
                ahead_1, ahead_2 = rest * w_1, rest * w_2
                comes_1, comes_2 = share * one * min(w_1, 0.0), share * two * min(w_2, 0.0)
            least_1, least_2 = min(least_1, one, flow[0, i]), min(least_2, two, flow[1, i])
            bend_1 -= way * rest * w_1
            bend_2 -= way * rest * w_2
        # Slow liquid does not spread up a slope, and a full gap, which answers a little more liquid by much
        # pressure, passes no more than the levels ask for.
        jump, asked, most = jump_1 + jump_2, 1.0, abs(apart) * full / slot
        if jump * apart < 0.0:
            asked = 1.0 - slow
        elif abs(jump) > most:
            asked = 1.0 - stiff * (1.0 - most / abs(jump))
        jump_1, jump_2 = asked * jump_1, asked * jump_2
        below = lower / (both + 1e-300)
        force[left] += share_l * (held_l - pressure) / step
        force[f] -= share_r * (held_r - pressure) / step
        fastest = max(fastest, fast)
        # Waves spread the depth of the whole, the flow alone what the two layers have of it.
        jump, waves = asked * jump, 0.5 * (fast - swift)
        mass_1 -= 0.5 * swift * jump_1 + waves * below * jump
        mass_2 -= 0.5 * swift * jump_2 + waves * (1.0 - below) * jump
        # Either side's own flow and what spreads besides have the velocity of where they come from, so that
        # streams that meet collide; waves even out the velocity of the whole. No layer gets momentum that it
        # has no mass for.
        bend = waves * (least_1 * bend_1 + least_2 * bend_2) / (least_1 + least_2 + 1e-300)
        work[_FLUX, f], work[_FLUX + 1, f] = mass_1, mass_2
        spreads_1, spreads_2 = mass_1 - flows_1 - comes_1, mass_2 - flows_2 - comes_2
        spreads_1 *= back_1 if spreads_1 > 0.0 else ahead_1
        spreads_2 *= back_2 if spreads_2 > 0.0 else ahead_2
        work[_FLUX + 2, f] = flows_1 * back_1 + comes_1 * ahead_1 + spreads_1 - least_1 * bend
        work[_FLUX + 3, f] = flows_2 * back_2 + comes_2 * ahead_2 + spreads_2 - least_2 * bend
    for k in range(2):
        for i in range(n):
            after = i + 1 if i < n - 1 else 0
            out = dt / step * (max(work[_FLUX + k, after], 0.0) - min(work[_FLUX + k, i], 0.0))
            work[_EDGE, i] = flow[k, i] / out if out > flow[k, i] else 1.0
        for f in range(n):
            donor = (f - 1) % n if work[_FLUX + k, f] > 0.0 else f
            work[_FLUX + k, f] *= work[_EDGE, donor]
            work[_FLUX + 2 + k, f] *= work[_EDGE, donor]
    counts = _counted(flow, full, free)
    for i in range(n):
        before, after = (i - 1) % n, i + 1 if i < n - 1 else 0
        whole = flow[0, i] + flow[1, i] + 1e-300
        square = (flow[0, i] * turn[0, i] ** 2 + flow[1, i] * turn[1, i] ** 2) / whole
        if free[i] * (flow[2, i] + flow[3, i]) < 0.0:
            force[i] += counts * free[i]
        rise = min(flow[0, after] + flow[1, after], full) - min(flow[0, before] + flow[1, before], full)
        rise *= 0.5 / step
        for k in range(2):
            push = flow[k, i] / whole * force[i] - 0.5 * rise * flow[k, i] * (turn[k, i] ** 2 - square)
            rate[k, i] = -(work[_FLUX + k, after] - work[_FLUX + k, i]) / step
            rate[2 + k, i] = push - (work[_FLUX + 2 + k, after] - work[_FLUX + 2 + k, i]) / step
    return fastest


@_part
def _calm(flow, full, spin):
    """Leave films the momentum of the velocity that `turnings` gives them; what the drum gives for it."""
    n, gained = flow.shape[1], 0.0
    for i in range(n):
        whole = flow[0, i] + flow[1, i]
        if whole < _FILM:
            gone = _FADED / (whole * whole + _FADED) if whole > DRY else 1.0
            for k in range(2):
                more = gone * (flow[k, i] * (1.0 - min(whole, full)) * spin - flow[2 + k, i])
                flow[2 + k, i] += more
                gained += more
    return gained * 2.0 * np.pi / n


@_part
def _drained(flow, had, turn, full):
    """Leave a layer that lost over half of a cell's area its velocity; what more it has is the other's.

    Liquid leaves with the velocity at the face, and what is left is pushed for all that was there: hardly any
    mass would keep that momentum.
    """
    for i in range(flow.shape[1]):
        rest = 1.0 - min(flow[0, i] + flow[1, i], full)
        for k in range(2):
            if flow[k, i] < 0.5 * had[k, i] and flow[k, i] < flow[1 - k, i]:
                own = flow[k, i] * rest * turn[k, i]
                flow[3 - k, i] += flow[2 + k, i] - own
                flow[2 + k, i] = own


@_part
def _spread(flow, turn, full, dt, work):
    """Viscosity along the wall, an explicit step [theory: pool, eq. 17]."""
    n = flow.shape[1]
    step = 2.0 * np.pi / n
    for k in range(2):
        for f in range(n):
            left, nu = (f - 1) % n, 0.0
            for i in (left, f):
                depth = 1.0 - _surface(flow[0, i] + flow[1, i], full)
                nu += 0.5 * closures.SPREADS * depth * abs(turn[0, i] - turn[1, i])
            least = min(flow[k, left], flow[k, f])
            work[_FLUX, f] = -min(nu, 0.25 * step * step / dt) * least * (turn[k, f] - turn[k, left]) / step
        for i in range(n):
            after = i + 1 if i < n - 1 else 0
            flow[2 + k, i] -= dt * (work[_FLUX, after] - work[_FLUX, i]) / step


@_part
def _shear(stream, table, slip, depth):
    """Shear on the wall over density and slip of the liquid there, 1/s [theory: friction, eq. 1]."""
    if stream.law == NONE:
        return 0.0
    if stream.law == LINEAR:
        return stream.coefficient * depth
    if stream.law == QUADRATIC:
        return stream.coefficient * slip
    if stream.law == STOKES:
        return stream.stokes * np.sqrt(slip)
    return mean_rate(table, stream.top, slip)[0]


@_part
def _sources(flow, pull, spin, stream, table, heavy, ring, dt, taken):
    """Exchange between the layers, walls and baffles over a time, implicitly [theory: pool, eq. 12-16].

    `heavy`: size of the body force over R. In a standing ring (`ring`) there is one layer, which fills the
    spaces between the baffles.
    """
    n = flow.shape[1]
    step, full = 2.0 * np.pi / n, stream.full
    plate, lever = stream.tip - stream.gap, 1.0 - 0.5 * (stream.tip + stream.gap)
    often = stream.baffles
    speed = abs(spin)
    # Linear friction drags on all of the liquid alike, which makes no stream.
    film = 0.0
    if stream.law != LINEAR:
        film = stream.grip * _shear(stream, table, speed, 1.0) * speed / (heavy + 1e-300)
    open_ = max(1.0 - closures.SHELTERS * often * stream.tip, 0.0)
    most = max(closures.DEPTH * stream.tip, open_ * film)
    torque, heat, lost = 0.0, 0.0, 0.0
    for i in range(n):
        whole = flow[0, i] + flow[1, i]
        if whole <= DRY:
            continue
        r = _surface(whole, full)
        rest, depth = 1.0 - min(whole, full), 1.0 - r
        if not ring:
            if flow[0, i] > most:
                moved = flow[0, i] - most
                spun = flow[2, i] * moved / flow[0, i]
                flow[0, i] -= moved
                flow[1, i] += moved
                flow[2, i] -= spun
                flow[3, i] += spun
            elif flow[1, i] > 0.0:
                w = flow[2, i] / (flow[0, i] * rest) if flow[0, i] > DRY else 0.0
                below = flow[3, i] / (flow[1, i] * rest) if flow[1, i] > DRY else 0.0
                if stream.shut > 0.0:
                    pace = 1e300
                else:
                    slip = abs(spin - below)
                    drawn = stream.grip * closures.DRAWN * _shear(stream, table, slip, depth)
                    pace = max(closures.RENEWED * often * abs(spin - w), open_ * drawn / (most + 1e-300))
                moved = min((most - flow[0, i]) * (1.0 - np.exp(-pace * dt)), flow[1, i])
                spun = flow[3, i] * moved / flow[1, i]
                flow[0, i] += moved
                flow[1, i] -= moved
                flow[2, i] += spun
                flow[3, i] -= spun
        one, two = flow[0, i], flow[1, i]
        w_1 = flow[2, i] / (one * rest) if one > DRY else 0.0
        w_2 = flow[3, i] / (two * rest) if two > DRY else 0.0
        slip_1, slip_2 = abs(spin - w_1), abs(spin - w_2)
        plates_1, wall_1, plates_2, wall_2, between = 0.0, 0.0, 0.0, 0.0, 0.0
        length, held = 0.0, 0.0
        if often > 0.0:
            turned = (one * w_1 * w_1 + two * w_2 * w_2) / (one + two)
            weight = max(turned + pull[i], 0.0) * depth + stream.slot * max(whole - full, 0.0) / full
            length = _resistance(depth, stream.tip, stream.gap, stream.loss)
            held = 2.0 * closures.VENTED * (1.0 if ring else stream.grip) * plate * weight
        if one > DRY:
            thin = min(1.0, one / (0.02 * plate)) if plate > 0.0 else 1.0
            width = stream.loss * one
            if stream.loss < 0.0:
                vented = length * held / (held + length * slip_1 * slip_1 + 1e-300)
                width = max(closures.DRAG * plate, vented)
            width = 1e6 if stream.shut > 0.0 else width
            plates_1 = 0.5 * often * width * slip_1 * lever * thin
            wall_1 = _shear(stream, table, slip_1, depth)
        if two > DRY:
            if often > 0.0:
                width = length * held / (held + length * slip_2 * slip_2 + 1e-300)
                plates_2 = 0.5 * often * width * slip_2
            if one <= 10.0 * DRY:
                wall_2 = _shear(stream, table, slip_2, depth)
        if stream.law == LINEAR:
            wall_1 = stream.coefficient * one * rest
            wall_2 = stream.coefficient * two * rest
        elif stream.law != NONE:
            wall_1 += stream.lid * _shear(stream, table, slip_1, depth) * one * rest
            wall_2 += stream.lid * _shear(stream, table, slip_2, depth) * two * rest
        if one > DRY and two > DRY:
            between = 0.125 * closures.INTERFACE * abs(w_2 - w_1)
        mass_1, mass_2 = max(one * rest, 1e-300), max(two * rest, 1e-300)
        drag_1, drag_2 = dt * (plates_1 + wall_1), dt * (plates_2 + wall_2)
        a, b, c = mass_1 + drag_1 + dt * between, mass_2 + drag_2 + dt * between, dt * between
        right_1, right_2 = mass_1 * w_1 + drag_1 * spin, mass_2 * w_2 + drag_2 * spin
        over = 1.0 / (a * b - c * c)
        last_1, last_2 = (right_1 * b + c * right_2) * over, (a * right_2 + c * right_1) * over
        if one > DRY:
            flow[2, i] = one * rest * last_1
            torque += drag_1 * (spin - last_1)
            heat += dt * wall_1 * (spin - last_1) ** 2
            lost += dt * plates_1 * (spin - last_1) ** 2
        if two > DRY:
            flow[3, i] = two * rest * last_2
            torque += drag_2 * (spin - last_2)
            heat += dt * wall_2 * (spin - last_2) ** 2
            lost += dt * plates_2 * (spin - last_2) ** 2
    taken.torque += torque * step
    taken.heat += heat * step
    taken.baffles += lost * step


@_jit
def stands(flow, x, y, full):
    """Whether the liquid's own mean rotation holds it to the wall all round [theory: pool, eq. 18]."""
    spinning, inertia, mean, n = 0.0, 0.0, 0.0, flow.shape[1]
    for i in range(n):
        whole = flow[0, i] + flow[1, i]
        spinning += flow[2, i] + flow[3, i]
        inertia += whole * (1.0 - min(whole, full))
        mean += whole / n
    own = spinning / (inertia + 1e-300)
    return own * own * _surface(mean, full) > np.sqrt(x * x + y * y)


@_jit
def advance(flow, spin, x, y, ring, dt, angles, stream, table, work, taken):
    """Advance both layers by a time, in place, in as many steps as their waves want; the fastest wave.

    `flow`: A_1, A_2 over R^2 and L_1, L_2 over R^4, shape (4, n); `spin` of the drum and body force `x`, `y`
    over R, means over the time; `angles` as `solvers.layer.state.ring`, standing; `taken` a record TAKEN,
    which is added to.
    """
    n = flow.shape[1]
    step, left, full, slot, rim = 2.0 * np.pi / n, dt, stream.full, stream.slot, stream.rim
    turn, after, rate = work[_TURN : _TURN + 2], work[_NEXT : _NEXT + 4], work[_RATE : _RATE + 4]
    heavy, greatest = np.sqrt(x * x + y * y), 0.0
    while left > 0.0:
        turnings(flow, full, spin, turn)
        fastest = _rates(flow, turn, x, y, angles, full, slot, rim, 0.0, work, rate)
        greatest = max(greatest, fastest)
        if not fastest < 1e9:
            return fastest
        tau = _COURANT * step / (1.05 * fastest + 1e-12)
        tau = left if tau >= left else (0.5 * left if tau > 0.5 * left else tau)
        _rates(flow, turn, x, y, angles, full, slot, rim, tau, work, rate)
        for j in range(4):
            for i in range(n):
                after[j, i] = flow[j, i] + tau * rate[j, i]
                if j < 2 and after[j, i] < 0.0:
                    after[j, i] = 0.0
        _drained(after, flow, turn, full)
        turnings(after, full, spin, turn)
        _rates(after, turn, x, y, angles, full, slot, rim, tau, work, rate)
        for j in range(4):
            for i in range(n):
                after[j, i] = 0.5 * (flow[j, i] + after[j, i] + tau * rate[j, i])
                if j < 2 and after[j, i] < 0.0:
                    after[j, i] = 0.0
        _drained(after, flow, turn, full)
        copy(after, flow)
        taken.torque += _calm(flow, full, spin)
        turnings(flow, full, spin, turn)
        _spread(flow, turn, full, tau, work)
        _sources(flow, work[_PULL], spin, stream, table, heavy, ring, tau, taken)
        left -= tau
        if left < 1e-12 * dt:
            left = 0.0
    return greatest


@_jit
def measure(flow, angles, full, slot, spin, work, out):
    """Fill `out`, a record FLOWS [theory: coupling, eq. 2-4]."""
    n = flow.shape[1]
    step, turn = 2.0 * np.pi / n, work[_TURN : _TURN + 2]
    turnings(flow, full, spin, turn)
    moment_x, moment_y, flow_x, flow_y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    energy, spinning, inertia, liquid = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        before, after = (i - 1) % n, i + 1 if i < n - 1 else 0
        whole = flow[0, i] + flow[1, i]
        held = min(whole, full)
        r, rest = _surface(whole, full), 1.0 - held
        r_b = _surface(flow[0, before] + flow[1, before], full)
        r_a = _surface(flow[0, after] + flow[1, after], full)
        # What is beyond a full gap lies at its inner wall.
        lever = 2.0 / 3.0 * held * (1.0 + r + r * r) / (1.0 + r) + r * (whole - held)
        moment_x += lever * angles[0, i] * step
        moment_y += lever * angles[1, i] * step
        # Limited: beside a cliff of one cell the difference across it is nobody's slope.
        bend = 2.0 * _limited(r - r_b, r_a - r)
        x = 0.5 * r * (angles[0, after] - angles[0, before]) + bend * angles[0, i]
        y = 0.5 * r * (angles[1, after] - angles[1, before]) + bend * angles[1, i]
        # Where the surface is steep liquid gives way across the wall: the axis feels less of its flow.
        slope = 0.5 * (r_a - r_b) / step
        left = rest / (rest + slope * slope)
        x, y = left * x, left * y
        moved = flow[0, i] * turn[0, i] + flow[1, i] * turn[1, i]
        flow_x += moved * x
        flow_y += moved * y
        light = whole / (rest * step)
        xx += light * x * x
        xy += light * x * y
        yy += light * y * y
        energy += 0.5 * step * (flow[2, i] * turn[0, i] + flow[3, i] * turn[1, i])
        beyond = max(whole - full, 0.0)
        energy += 0.5 * step * slot * beyond * beyond / full
        spinning += step * (flow[2, i] + flow[3, i])
        inertia += step * whole * rest
        liquid += step * whole
    out.moment_x, out.moment_y, out.flow_x, out.flow_y = moment_x, moment_y, flow_x, flow_y
    # What the flow answers to a force lies between nothing, off the wall, and its mass: from the middle the
    # rounds that agree with a rotor come together, however light it is.
    share = min(1.0, 0.7 * liquid / (max(xx, yy) + 1e-300))
    out.xx, out.xy, out.yy = share * xx, share * xy, share * yy
    out.energy, out.spinning, out.inertia = energy, spinning, inertia
