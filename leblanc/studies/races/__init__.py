"""Scenes with balls in races: how they rest at each speed, and where a run-up finds them."""
