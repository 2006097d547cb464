"""Campaigns: many runs of the same job with other values and seeds, and the table of their results."""
