"""Nonlinear long waves of a layer under a prescribed whirl, by finite volumes in time [theory: long_wave].

`settle` has the liquid model `LongWave` and what it rests on (`simulate`, `settle`, `film`); `state` is a
layer at one moment. The compiled parts are `finite_volume` (rates of change) and `step` (time steps, whose
parts the run-up takes as well); `records` names what they work on, and how they end.
"""
