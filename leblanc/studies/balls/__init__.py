"""Balls in races: how they rest in the drum at each speed."""
