"""The steady answer of a rotor with liquid to its unbalance.

`response` is the entry for every rotor, critical speeds included; `models` has liquid models, `errors` what
an answer's error is before anything is solved. A planar rotor is solved by `planar` and `pairs`, any other
by `balance` and `coupled`.
"""
