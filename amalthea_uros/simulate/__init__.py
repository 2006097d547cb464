"""Simulation: what a system does in time, event by event, and what can be observed of it."""
