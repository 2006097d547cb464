"""A model against a measurement: what was measured, whether the predictions hold, and measured values for the description."""
