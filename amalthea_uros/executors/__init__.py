"""Executors: threads that wait for messages and timers in a loop, and call what is ready (rclc and its middleware).

`semantics` has the rules of the sources, one small function each, for bounds and simulation alike; `bounds` has the analysis.
"""
