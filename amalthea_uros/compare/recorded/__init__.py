"""What a recording of ROS 2 says of the host, and the description of it."""
