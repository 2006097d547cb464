"""The tables and the hand-written rest, one file for each sub-model."""
