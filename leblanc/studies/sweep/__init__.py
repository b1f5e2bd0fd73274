"""Sweeps over scenes: what varies, samples, workers, the store, what was found."""
