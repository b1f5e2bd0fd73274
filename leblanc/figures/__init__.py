"""The figures of results, as PNG and SVG, and films.

Figures are drawn on the object interface: to import pyplot costs more than to draw them all. `page` is the
only door to matplotlib; a figure carries its caption, its alternative text and its size.
"""
