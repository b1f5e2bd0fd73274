"""Sloshing in a drum of any section by finite elements: modes, damping, forced answer."""
