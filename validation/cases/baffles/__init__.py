"""Layers with baffles against computed two-phase flow: ten runs of a ring in the plane [theory: baffles]."""
