"""Models of older AMALTHEA versions, ITEA 1.1.0 to 3.3.0, one version on (or back) per step, and where the results go."""
