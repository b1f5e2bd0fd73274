"""Figures of rotors with liquid or balls."""
