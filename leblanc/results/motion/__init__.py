"""What a response says of the motion beside a circle with the spin: tilting, self-excited, held in time."""
