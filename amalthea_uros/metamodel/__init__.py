"""AMALTHEA: what its versions declare, typed classes for their union, models of them."""
