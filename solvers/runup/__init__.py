"""Rotor and liquid layers through time together: run-up, run-down, hold [theory: coupling].

`runup.run_up` is what a study calls. It drives any `machine.RunupMachine`: `long_wave` (steps in `kernel`,
records in `state`) or `linear` (`linear_kernel`). `drive` has the ramp and the motor, `chamber` a layer's
properties, `error` how far linear layers may be trusted.
"""
