"""Dry rotor models."""
