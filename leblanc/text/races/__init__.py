"""Balls in races, in words."""
