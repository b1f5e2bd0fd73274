"""Three-dimensional pictures, films and pages of a machine."""
