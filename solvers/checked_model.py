"""A liquid model of somebody else, its answers checked before a solver takes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from fluid.fill import FULL, Fills
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.liquid_model import ROUNDING, LiquidAnswer, LiquidModel, Whirls

_SMALL = 1e-6  # of the depth: a whirl that stands for one without end small
_STILL = 0.1  # of the force in that whirl, that may be left without a deflection
_STEP = 1e-6  # relative, of the deflection, by which a slope is found
_FIELD = "model"
_FLAGS = "dry_patch", "converged"
_REAL = ("error",)


@dataclass(frozen=True, eq=False)
class CheckedModel(LiquidModel):
    """Any object with a name and `answer`; what it does not have is found from its answers.

    Its liquid may pull across the deflection in a synchronous whirl, and its law may bend as it likes.
    """

    own: Any  #: the object
    called: str = ""  #: its name; what it calls itself if empty
    across = True

    def __post_init__(self) -> None:
        name = self.called or getattr(self.own, "name", None)
        if not isinstance(name, str) or not name.strip() or not name.isprintable():
            raise InputError(f"{_FIELD}.name", name, "a text that names it in results")
        if not callable(getattr(self.own, "answer", None)):
            kind = type(self.own).__name__
            raise InputError(
                _FIELD, kind, "an object with a method answer(fills, whirls), as LiquidModel says"
            )

    @property
    def name(self) -> str:
        """See `LiquidModel`."""
        return self.called or str(self.own.name)

    def answer(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `LiquidModel`; an `InputError` where what comes back is no such answer."""
        found = self._asked(fills, whirls)
        unknown = found.converged & np.isnan(found.slope)
        if not unknown.any():
            return found
        at = np.flatnonzero(unknown)
        return replace(found, slope=_with(found.slope, at, self._slope(fills.at(at), whirls.at(at))))

    def _slope(self, fills: Fills, whirls: Whirls) -> Complex:
        """Derivative of U with respect to the size of the deflection, kg, by its answers beside it."""
        size = whirls.amplitude
        still = size == 0.0
        base = np.where(still, _SMALL * fills.depth, size)
        share = np.where(still, 1.0, _STEP)
        turn = np.exp(1j * np.angle(whirls.deflection)) if np.iscomplexobj(whirls.deflection) else 1.0
        low, high = (
            self._asked(fills, replace(whirls, deflection=base * (1.0 + way * share) * turn)).unbalance
            for way in (-1.0, 1.0)
        )
        return np.asarray((high - low) / (2.0 * base * share))

    def transfer(self, fills: Fills, whirls: Whirls) -> tuple[Complex, Flags]:
        """U of a small whirl over its deflection, kg, and where it is known."""
        size = _SMALL * fills.depth
        found = self._asked(fills, replace(whirls, deflection=size))
        return np.asarray(found.unbalance / size), found.converged

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """See `LiquidModel`: not known."""
        return np.zeros(speed.shape)

    def _asked(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """Its answer; where a chamber has no free surface, that of liquid that moves like a solid."""
        full = fills.volume >= FULL * np.array([fill.chamber.capacity for fill in fills.origin])[fills.which]
        if full.any():
            apart = np.flatnonzero(~full), np.flatnonzero(full)
            parts = [_solid(fills.at(apart[1]), whirls.at(apart[1]))]
            if apart[0].size:
                parts.insert(0, self._asked(fills.at(apart[0]), whirls.at(apart[0])))
            return LiquidAnswer.joined(parts).at(np.argsort(np.concatenate(apart)))
        try:
            found = self.own.answer(_kept(fills), _kept(whirls))
        except InputError:
            raise
        except Exception as error:
            said = f"{type(error).__name__}: {error}"
            raise InputError(
                f"{_FIELD}.answer", said, "an answer to every whirl, out of its range as well"
            ) from error
        return _checked(found, len(fills))


def _kept(part: Any) -> Any:
    """The same dataclass of arrays, none of which may be written to; they are the solvers' own."""
    new = {}
    for each in fields(part):
        value = getattr(part, each.name)
        if isinstance(value, np.ndarray):
            value = value.view()
            value.flags.writeable = False
        elif each.name == "chamber":
            value = _kept(value)
        new[each.name] = value
    return replace(part, **new)


def _solid(fills: Fills, whirls: Whirls) -> LiquidAnswer:
    """Answer of liquid without a free surface."""
    yes = np.ones(len(fills), dtype=bool)
    unbalance = (fills.mass * whirls.amplitude).astype(complex)
    offset, error = np.zeros(len(fills), dtype=complex), np.full(len(fills), ROUNDING)
    return LiquidAnswer(unbalance, fills.mass, offset, ~yes, yes, {}, error)


def _with(values: Any, at: Any, new: Any) -> Any:
    """A copy with other values at some places."""
    copy = values.astype(np.result_type(values, new))
    copy[at] = new
    return copy


def _checked(found: Any, size: int) -> LiquidAnswer:
    """The answer, or an `InputError` that names what is wrong with it."""
    if not isinstance(found, LiquidAnswer):
        raise InputError(f"{_FIELD}.answer", type(found).__name__, "a solvers.liquid_model.LiquidAnswer")
    values = {each.name: getattr(found, each.name) for each in fields(found)}
    limits = values.pop("limits")
    if not isinstance(limits, Mapping) or not all(isinstance(name, str) for name in limits):
        raise InputError(f"{_FIELD}.answer.limits", type(limits).__name__, "flags by the names of the limits")
    values |= {f"limits.{name}": kept for name, kept in limits.items()}
    for name, array in values.items():
        flags = name in _FLAGS or name.startswith("limits.")
        kinds, what = (
            ("b", "truth values")
            if flags
            else ("fiu", "real numbers")
            if name in _REAL
            else ("fiuc", "numbers")
        )
        allowed = f"an array of {what}, shape ({size},)"
        if not isinstance(array, np.ndarray):
            raise InputError(f"{_FIELD}.answer.{name}", type(array).__name__, allowed)
        if array.dtype.kind not in kinds or array.shape != (size,):
            raise InputError(f"{_FIELD}.answer.{name}", f"{array.dtype} of shape {array.shape}", allowed)
    for name in ("unbalance", "offset"):
        lost = found.converged & ~np.isfinite(values[name])
        if lost.any():
            value = complex(values[name][lost][0])
            raise InputError(
                f"{_FIELD}.answer.{name}", value, "finite where converged says that it was found"
            )
    if np.any(found.error < 0.0):
        least = float(np.nanmin(found.error))
        raise InputError(f"{_FIELD}.answer.error", least, "0 or above, or nan where it is not known")
    return found


def require_outwards(model: CheckedModel, fills: Fills, whirls: Whirls) -> None:
    """Raise `InputError` where liquid is pulled against a small synchronous whirl, as by a wrong sign.

    And where it is pulled without a deflection, as those whirls are: the response is that to the unbalance.
    """
    if not len(fills):
        return
    still = model.answer(fills, whirls)
    pulled = still.converged & (np.abs(still.unbalance) > _STILL * fills.mass * _SMALL * fills.depth)
    if pulled.any():
        value = f"{complex(still.unbalance[pulled][0]):g} kg m without a deflection"
        raise InputError("model.answer.unbalance", value, "0 there: what pulls without one is an unbalance")
    mass, known = model.transfer(fills, whirls)
    wrong = known & (mass.real < 0.0)
    if wrong.any():
        allowed = "0 or above over the deflection in a synchronous whirl, which throws liquid outwards"
        raise InputError("model.answer.unbalance", f"{float(mass.real[wrong][0]):g} kg", allowed)
