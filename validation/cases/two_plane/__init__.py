"""Balancing in two planes [FF20]."""
