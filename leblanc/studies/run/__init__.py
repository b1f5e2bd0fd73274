"""Response and the liquid's centre of mass at each speed of a scene."""
