"""What the results of processes consist of, and where it comes from that they are unknown."""
