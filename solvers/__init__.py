"""How it is solved: quadrature, root finding, finite elements, the rotor's answer."""
