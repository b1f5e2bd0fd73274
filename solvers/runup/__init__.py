"""Rotor and liquid layers through time together: run-up, run-down, hold [theory: coupling]."""
