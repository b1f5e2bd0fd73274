"""The terminal: what commands print and write, and what they show while they work."""
