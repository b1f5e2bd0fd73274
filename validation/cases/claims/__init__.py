"""Claims of the sources that print no equation: several chambers, a swing of 35 mm, rules for a layout."""
