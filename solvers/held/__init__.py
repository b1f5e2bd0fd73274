"""A rotor with its waves held at constant speed until nothing changes any more [theory: held].

`hold` finds the state of one speed on py-pde's road, or with exact waves by
`exact`, `branch` those of many with the states carried up and down from speed to speed.
"""
