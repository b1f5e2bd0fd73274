"""Meshes and outlines from files and to files; each file library has its one door here."""
