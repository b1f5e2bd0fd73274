"""How a scene is read: rules of single values, tables of known keys, paths, and the messages of faults."""
