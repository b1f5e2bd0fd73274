"""Chambers seen along the axis, drawn on axes that are handed in."""
