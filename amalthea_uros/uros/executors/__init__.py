"""Executors that spin in loops: where callbacks run, their handles, and the iterations of their threads."""
