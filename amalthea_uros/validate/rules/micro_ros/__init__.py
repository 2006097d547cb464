"""Findings about micro-ROS applications that fail or are fragile; reported while a description is assembled."""
