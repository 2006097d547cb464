"""Logs of CAN buses: frames in time, and the formats of log files."""
