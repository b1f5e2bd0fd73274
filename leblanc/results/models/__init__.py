"""The same scene by several liquid models, side by side."""
