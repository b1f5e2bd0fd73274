"""Steady answer of a rotor with liquid to its unbalance.

`response` is the entry for every rotor, critical speeds included; `models` has liquid models, `errors` an
answer's error before anything is solved. Planar rotors are solved by `planar` and `pairs`, others by
`balance` and `coupled`.
"""
