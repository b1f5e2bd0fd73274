"""The figures of a run-up and its film."""
