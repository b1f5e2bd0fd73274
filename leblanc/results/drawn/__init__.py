"""Machines as pictures draw them: with liquid, balls in races."""
