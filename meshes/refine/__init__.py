"""Meshes refined and cut along circles about an axis, so that they follow a free surface."""
