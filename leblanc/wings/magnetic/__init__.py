"""A rotor in magnetic bearings: its control, how it holds the rotor over speed and in time."""
