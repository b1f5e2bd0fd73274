"""The synchronous answer of a rotor with liquid: liquid models, every branch, estimated errors."""
