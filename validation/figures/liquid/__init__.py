"""Figures of liquid alone: layers, baffles, the exact wave, best volumes."""
