"""Balls in their races: states, numbers, charts of stability, designs, and machines with them as drawn."""
