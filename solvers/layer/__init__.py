"""Nonlinear long waves of a layer under a prescribed whirl, by finite volumes in time [theory: long_wave].

The compiled core: `finite_volume` (rates of change) and `step` (time steps, whose parts the run-up takes as
well); `records` names what they work on, and how they end, `state` has equilibrium and means of a layer.
`solvers.pypde` drives it through time.
"""
