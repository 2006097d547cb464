"""What executors and their middleware do, as pure functions of the model; after ros2/rclc, ros2/rcl and micro-ROS/rmw_microxrcedds."""
