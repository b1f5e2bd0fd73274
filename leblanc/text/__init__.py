"""Results in words and numbers, for terminals and reports."""
