"""Executors that spin in loops: where callbacks run, their handles, and the rounds of their threads."""
