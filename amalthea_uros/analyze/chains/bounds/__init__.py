"""Bounds of end-to-end latencies, one file per paper."""
