"""Results over all phases of what comes from outside."""
