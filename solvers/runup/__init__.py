"""Rotor and liquid layers through time together: run-up, run-down, hold [theory: coupling].

`runup.run_up`, what studies call, drives any `machine.RunupMachine`, which a liquid model makes:
`long_wave.couple` (steps in `steps.coupled`) or `linear.couple_linear` (`steps.linear`). `machine` also has
ramp and motor, `state` what the steps work on. `runup.SteppedRunup` goes on step by step, as others ask.
"""
