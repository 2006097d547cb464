"""Rules for models: one rule, one file, below `rules/<profile>`."""
