"""Bounds of what executors do: response times of callbacks, messages that are lost, times of publications."""
