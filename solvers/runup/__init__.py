"""Rotor and liquid layers through time together: run-up, run-down, hold [theory: coupling].

`runup.run_up` is what a study calls, with a liquid model as an object: it drives any `machine.RunupMachine`,
which `long_wave.couple` (steps in `kernel`) or `linear.couple_linear` (`linear_kernel`) makes. `machine`
also has the ramp and the motor, `state` what the steps work on.
"""
