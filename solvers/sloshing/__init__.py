"""Sloshing in a spinning drum of any section by finite elements [theory: sloshing].

`system` condenses a mesh of the liquid, `modes` and `forced` answer from it; `reduced` keeps the few motions
that a whirling rotor knows of; `model` is the liquid model.
"""
