"""Meshes of the ring of liquid between free surface and wall, and of compartments."""
