"""Figures of rotors with balls in races."""
