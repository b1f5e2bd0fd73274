"""Results of balls in their races: charts of their stability, and machines with them as drawn."""
