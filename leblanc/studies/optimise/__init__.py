"""The best volumes of a scene's chambers for an objective the user names [theory: optimum]."""
