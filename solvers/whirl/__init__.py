"""Self-excited whirl: growth, whirl speed and the edges of its bands of speed [theory: whirl]."""
