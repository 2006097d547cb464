"""What is known of micro-ROS: how its callbacks execute on a controller, what messages cost, how it starts, what it needs."""
