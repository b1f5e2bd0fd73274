"""Balancers that are no liquid: balls in races, at rest in the rotor and in motion.

`states`, `stability`, `steady` and `charts` are about rest, `motion`, `steps` and `balancers` about motion in
time. `two_plane_balance` tells when balancers of any kind balance a rigid rotor.
"""
