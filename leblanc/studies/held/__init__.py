"""Held states of a scene: rotor and long waves at constant speed until they settle; workers, what is kept."""
