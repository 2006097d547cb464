"""What executors that spin in loops mean in time, one rule per file; sources are files of ros2/rclc, ros2/rcl and micro-ROS/rmw_microxrcedds."""
