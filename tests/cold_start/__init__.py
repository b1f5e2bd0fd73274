"""What a command takes from a cold start, and where the time goes."""
