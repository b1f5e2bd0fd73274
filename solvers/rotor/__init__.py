"""Rotors without liquid: one class for each kind, with its equations of motion.

`system` has the matrices and the protocol, `jeffcott`, `two_plane`, `tub`, `exciter/` and `magnetic/` are the
kinds, `vibration` and `campbell` what any of them does without liquid. `vector_model` and `balls/` are other
balancers.
"""
