"""Waves of one family: steady by Newton's method and continuation, in time by exponential steppers."""
