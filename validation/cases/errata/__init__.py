"""Errata of the sources: what is printed beside what is derived, each computed [theory: errata]."""
