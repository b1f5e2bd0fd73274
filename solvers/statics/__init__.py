"""The liquid at rest in a whirling, spinning chamber: quadrature along the wall, finite elements."""
