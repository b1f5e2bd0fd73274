"""The liquid at rest in a whirling, spinning chamber.

`hydrostatics` solves for the free surface and its optimal volume, on exact integrals (`wall`);
`free_surface` does the same on finite elements, `law_defect` bounds what the law is below a straight line.
"""
