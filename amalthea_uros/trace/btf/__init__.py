"""Traces in the Best Trace Format (BTF) of versions 2.1 to 2.3."""
