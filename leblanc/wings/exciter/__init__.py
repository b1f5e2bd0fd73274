"""A vibrating table shaken by balls that can stick to a speed below the shaft's."""
