"""Values that vary: random numbers, the same on every machine, and the distributions that they are drawn from."""
