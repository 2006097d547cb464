"""From a system to what the kernel executes: records in its memory, and programs of operations for its processes."""
