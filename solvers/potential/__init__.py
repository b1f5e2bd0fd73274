"""The fully nonlinear wave of a layer: any height, any depth, no friction [theory: potential].

A conformal map turns the layer into a strip (`strip`); `steady` solves for waves that stand in the frame of
their whirl, free ones among them, and follows them in any parameter, folds included; `unsteady` has the
rates and forces of any surface, `in_time` takes it through time, `histories` does so under a whirl, and
`coupled` takes layers through time with a rotor.
"""
