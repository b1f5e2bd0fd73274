"""Nonlinear long waves of a layer under a prescribed whirl, by finite volumes in time."""
