"""Times measured in traces: pairing of events, baselines, statistics."""
