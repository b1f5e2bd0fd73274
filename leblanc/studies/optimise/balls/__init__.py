"""The balls of a scene that are best for an objective: count, size, drag and race of each."""
