"""Conversion between the generic performance model and AMALTHEA: `build` in one direction, `extract` in the other.

Where both have objects of the same structure, a table maps classes to classes and fields to features. It drives both directions, so
that they are inverse to each other by construction. Objects of different structure are converted by code, both directions in one file.
"""
