"""Figures of the exciter's pages."""
