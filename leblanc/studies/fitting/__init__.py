"""Steps of a fit: the table that was measured, the scene's answer to it, the search, noise and errors."""
