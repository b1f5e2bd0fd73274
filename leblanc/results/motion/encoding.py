"""Complex and unknown numbers as JSON and netCDF take them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.results.netcdf import Variable
from leblanc.results.netcdf import variable as var


def finite(values: NDArray[Any]) -> list[Any]:
    """Nested lists, None in place of what is not finite, complex numbers as [re, im]."""
    known = np.isfinite(values)
    if np.iscomplexobj(values):
        values, known = np.stack([values.real, values.imag], axis=-1), np.stack([known, known], axis=-1)
    if known.all():
        return list(values.tolist())
    found: list[Any] = np.where(known, values, np.array(None)).tolist()
    return found


def pair(name: str, dims: tuple[str, ...], values: NDArray[Any], long_name: str) -> dict[str, Variable]:
    """Real and imaginary part of a deflection, both nan where one is."""
    values = np.where(np.isnan(values), complex(np.nan, np.nan), values)
    return {
        f"{name}_real": var(dims, values.real, "m", f"{long_name}, real part", "along the unbalance"),
        f"{name}_imag": var(dims, values.imag, "m", f"{long_name}, imaginary part", "90 deg ahead of it"),
    }
