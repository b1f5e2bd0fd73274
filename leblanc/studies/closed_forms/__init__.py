"""Analytical checks beside a scene's answer: `told` gathers those that the scene has the data for."""
