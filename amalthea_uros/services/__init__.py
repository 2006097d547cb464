"""Files in, results out: what the command line and scripts share. Each result holds everything that is needed to show it."""
