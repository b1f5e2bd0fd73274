"""What the balls of a scene are in numbers, beside those of the scene without them."""
