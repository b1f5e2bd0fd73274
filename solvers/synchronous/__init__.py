"""The steady answer of a rotor with liquid to its unbalance.

`response` is the entry for every rotor, `models` has the liquid models as objects (`discrete` on grids),
`estimate` the errors of both before anything is solved, `critical` the critical speeds with liquid.
"""
