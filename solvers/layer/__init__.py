"""Nonlinear long waves of a layer under a prescribed whirl, by finite volumes in time [theory: long_wave].

`settle` has what a study calls (`simulate`, `settle`, `film`), `prescribed` what is asked and answered. The
compiled parts are `face_flux`, `finite_volume` (rates of change) and `step` (time steps, whose parts the
coupled run-up takes as well); `records` names what they work on, `state` and `loads` carry it.
"""
