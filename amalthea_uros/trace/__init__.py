"""Traces: events in time as one table of columns, and the formats in which they are written and read."""
