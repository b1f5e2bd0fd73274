"""The wave of a liquid layer: picture, curves over time, film."""
