"""Bodies of liquid in three dimensions, as tetrahedra in columns on a plane mesh."""
