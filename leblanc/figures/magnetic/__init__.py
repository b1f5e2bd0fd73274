"""Figures of rotors in magnetic bearings: `control` of `run`, `force` of `explain`."""
