"""XRCE-DDS: rmw_microxrcedds with its client, the middleware of micro-ROS."""
