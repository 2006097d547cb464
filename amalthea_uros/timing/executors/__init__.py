"""What executors that spin in loops mean in time, one rule per file; after ros2/rclc, ros2/rcl and micro-ROS/rmw_microxrcedds."""
