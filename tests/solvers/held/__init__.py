"""Tests of solvers.held."""
