"""Friction of the liquid on its walls: laws of the wall's shear, laminar layers under an oscillation."""
