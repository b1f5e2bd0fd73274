"""Figures and tables of the pages, drawn from cases, sources and kept measurements."""
