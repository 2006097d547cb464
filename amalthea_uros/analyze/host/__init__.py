"""The executors of ROS 2 on a host: one file for each published method, and what combines them."""
