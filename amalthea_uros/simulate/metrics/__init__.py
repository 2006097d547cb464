"""What can be observed of jobs and chains, kept as distributions of a size that does not grow with the duration of a run."""
