"""Self-excited whirl [theory: whirl].

`growth` is the entry: growth rate and whirl speed of the mode that grows most, for any rotor, fills and
friction; `edges` refines bands of speed. `planar`, `system`, `laminar` and `sections` find modes, `sheets`
all of laminar friction at once; `count` tells whether one was missed.
"""
