"""Facts about micro-ROS in C and C++ sources, and the description that follows from them; the code is read, never run."""
