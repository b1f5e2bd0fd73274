"""A scene with balls in numbers."""
