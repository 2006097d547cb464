"""Solvers: each for the problems that it can prove something about, or that are too large for a proof."""
