"""Loads and clearances of a machine: forces under its feet, clearances, forces in its parts, its motor."""
