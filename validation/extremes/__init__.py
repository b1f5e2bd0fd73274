"""The models at the ends of what may be asked: an answer with its error, or a plain no."""
