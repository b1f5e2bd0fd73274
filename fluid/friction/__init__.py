"""Friction of the liquid: laws of the wall's shear, laminar layers under an oscillation, loss at baffles."""
