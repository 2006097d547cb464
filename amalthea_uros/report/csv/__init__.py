"""Results as rows of comma-separated values."""
