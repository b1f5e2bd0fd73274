"""A package of one's own: a kind of machine and a command."""
