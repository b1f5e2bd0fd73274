"""Answers about a spindle unit and its rolling bearings as text."""
