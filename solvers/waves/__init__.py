"""Waves of one family in a layer under a whirl [theory: kdv].

Steady: `steady.solve` (one wave by Newton's method), `follow` and `respond` (all of them over the whirl
speed), `growth_rates` (which of them last); `modes` and `newton` are what they are made of. In time:
`stepper`. `one_family` is the liquid model.
"""
