"""The front room: one scene in, results out."""
