"""Compiled steps in time of a rotor and what it carries."""
