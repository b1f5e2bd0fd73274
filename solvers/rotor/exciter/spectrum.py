"""Lines in the vibration of an exciter's platform, and the few frequencies that they are made of."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_positive


@dataclass(frozen=True)
class Lines:
    """Lines of a spectrum by size; l lines."""

    frequency: Array  #: angular, shape (l,)
    amplitude: Array  #: shape (l,)
    #: angular frequency of one turn in the whole time: lines closer than four of it are one
    resolution: float


def spectrum(samples: Array, sample_time: float) -> tuple[Array, Array]:
    """Amplitude spectrum with a Hann window.

    Angular frequency and amplitude, shapes (s // 2 + 1,): a sine shows its amplitude where it has a whole
    number of turns.
    """
    require_positive("sample_time", sample_time)
    if samples.size < 16:
        raise InputError("samples", samples.size, "16 or more")
    window = 0.5 * (1.0 - np.cos(2.0 * math.pi * np.arange(samples.size) / samples.size))
    amplitude = np.abs(np.fft.rfft((samples - samples.mean()) * window)) * 4.0 / samples.size
    frequency = 2.0 * math.pi * np.fft.rfftfreq(samples.size, sample_time)
    return np.asarray(frequency, dtype=np.float64), np.asarray(amplitude, dtype=np.float64)


def lines(samples: Array, sample_time: float, least: float = 0.01) -> Lines:
    """Lines that stand out of the spectrum.

    Those above `least` of the largest; a steady line between two frequencies of the transform is exact but
    for the leakage of others.
    """
    if not 0.0 < least < 1.0:
        raise InputError("least", least, "between 0 and 1")
    frequency, amplitude = spectrum(samples, sample_time)
    inner = amplitude[1:-1]
    peak = 1 + np.flatnonzero(
        (inner > amplitude[:-2]) & (inner >= amplitude[2:]) & (inner > least * amplitude.max())
    )
    before, at, after = amplitude[peak - 1], amplitude[peak], amplitude[peak + 1]
    # Of a Hann window: the two largest values of one line stand as 2 - d to 1 + d, d the place between them.
    larger, side = np.maximum(before, after), np.where(after >= before, 1.0, -1.0)
    place = (2.0 * larger - at) / (larger + at)
    exact = at * math.pi * place * (1.0 - place**2) / np.where(place != 0.0, np.sin(math.pi * place), 1.0)
    exact = np.where(np.abs(place) > 1e-9, exact, at)
    resolution = float(frequency[1])
    order = np.argsort(-exact)
    return Lines((frequency[peak] + side * place * resolution)[order], exact[order], resolution)


def combination(
    frequency: float, basic: Sequence[float], order: int, within: float
) -> tuple[int, ...] | None:
    """Integers whose sum with basic frequencies is a given one, the smallest that do.

    None where no sum of integers, their sizes together at most `order`, comes within `within`.
    """
    choices = itertools.product(range(-order, order + 1), repeat=len(basic))
    found = [
        chosen
        for chosen in choices
        if sum(map(abs, chosen)) <= order
        and abs(sum(k * w for k, w in zip(chosen, basic, strict=True)) - frequency) <= within
    ]
    return min(found, key=lambda chosen: (sum(map(abs, chosen)), chosen), default=None)
