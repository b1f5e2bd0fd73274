"""A scene of kind "magnetic" in: `run` answers with its control, `explain` with its numbers."""
