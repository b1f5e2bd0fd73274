"""Results as lines and tables of text, for terminals and reports."""
