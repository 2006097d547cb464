"""Mutated models and descriptions, and what must hold for every command whatever it reads."""
