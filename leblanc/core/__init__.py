"""Quantities, answers, questions, blocks and their renderers; units, files, interrupts."""
