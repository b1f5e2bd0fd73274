"""The liquid as drawn: where every chamber is, and its liquid as closed bodies in space.

The free surfaces are those of the deflection as it is drawn, larger than it is where that is small.
"""
