"""Figures: the page they stand on, curves and chambers that several draw, what a picture shows.

`page` is the only door to matplotlib; figures are drawn on its object interface, since to import pyplot costs
more than to draw them all.
"""
