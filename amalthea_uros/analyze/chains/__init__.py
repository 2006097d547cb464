"""Latencies of cause-effect chains: one file per method, all on the reads and writes of jobs or on periods and response times."""
