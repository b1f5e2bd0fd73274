"""Which liquid model answers where, why, and how well; models by name."""
