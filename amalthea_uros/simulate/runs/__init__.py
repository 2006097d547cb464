"""Runs of the kernel: what drives it, what is observed in them, and the verdicts on that."""
