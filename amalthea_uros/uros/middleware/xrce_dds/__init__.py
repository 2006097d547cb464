"""Micro XRCE-DDS, the middleware of micro-ROS."""
