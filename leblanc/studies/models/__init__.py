"""Liquid models of a scene: by their names, chosen within a tolerance, and how far to believe them."""
