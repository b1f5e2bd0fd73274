"""Layout of a tub and the names of loads."""
