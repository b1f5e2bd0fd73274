"""Experiments of others beside what follows from their statements: whirl, torsion, a ring under gravity."""
