"""Response times in executors that spin in loops, one method or kind of handle per file."""
