"""Response times, one method per file."""
