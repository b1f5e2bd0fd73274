"""Liquid alone: layers under a whirl, the exact wave, the volumes that are best."""
