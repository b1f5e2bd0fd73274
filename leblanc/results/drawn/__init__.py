"""The machine and its liquid as pictures draw them, and how much larger than they are."""
