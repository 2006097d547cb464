"""Where processes run, and in which order."""
