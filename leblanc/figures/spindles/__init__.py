"""Answers about a spindle unit as figures."""
