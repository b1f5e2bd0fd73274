"""Waves of one family in a layer under a whirl [theory: kdv].

Steady: `periodic.solve` (one wave by Newton's method), `continuation.follow` and `respond` (all of them over
the whirl speed), `continuation.growth_rates` (which of them last). In time: `stepper` with the methods of
`exponential`, for the equation of `terms`. `modes`, `newton` and `path` are what the steady ones are made of.
"""
