"""Times of jobs and latencies of chains in a simulation or a measurement."""
