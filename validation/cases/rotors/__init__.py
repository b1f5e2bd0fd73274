"""Rotors with their liquid, bearings and motors: rigs, tubs, spindles, a pump, whirl and run-ups."""
