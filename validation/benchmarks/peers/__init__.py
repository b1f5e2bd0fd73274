"""Other codes on the same problems; each may be missing."""
