"""Where a state of the balls is stable, over speed and another number of the scene."""
