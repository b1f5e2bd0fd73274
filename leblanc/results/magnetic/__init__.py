"""What is answered of a rotor in magnetic bearings: `control` by `run`, `explanation` by `explain`."""
