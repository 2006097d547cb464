"""Traces in the Common Trace Format 1.8 (diamon.org/ctf): of Zephyr, ros2_tracing, LTTng, barectf."""
