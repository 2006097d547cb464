"""Data flow: positions of activities in jobs, occurrences of events, links between them, chains and paths."""
