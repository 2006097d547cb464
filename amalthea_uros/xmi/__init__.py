"""Models in files: the format, the migration between versions, loading and saving."""
