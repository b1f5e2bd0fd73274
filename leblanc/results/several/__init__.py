"""Answers to one question asked of several scenes."""
