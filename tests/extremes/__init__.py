"""The models and commands at the ends of what may be asked, and how far their estimated errors hold."""
