"""A rigid rotor in magnetic bearings.

`machine` has its forces, `control` what drives the coils, `linear` poles and margins of the closed loop,
`motion` the nonlinear motion in time.
"""
