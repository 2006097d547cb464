"""Traces for viewers: slices and marks on tracks, and the formats of Perfetto and Chrome."""
