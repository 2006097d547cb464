"""From a system to what the kernel plays: records in its memory, and programs of operations for its processes."""
