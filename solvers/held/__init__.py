"""Time-integrated steady states: a rotor with its waves at constant speed until converged [theory: held].

`hold` finds the state of one speed on py-pde, or with nonlinear waves by `exact`; `branch` those of many,
carried up and down from speed to speed.
"""
