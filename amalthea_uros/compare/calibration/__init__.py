"""Measured values for a description: which of them it states, where, and in which form."""
