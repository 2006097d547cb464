"""What makes an application impossible or fragile on micro-ROS; found while its description becomes a system."""
