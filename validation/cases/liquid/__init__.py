"""Liquid alone: layers under a whirl, the fully nonlinear wave, the volumes that are best."""
