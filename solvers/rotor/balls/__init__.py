"""Ball balancers: balanced states and motion in time."""
