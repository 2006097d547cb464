"""The host in a recording of ROS 2, and the description of it."""
