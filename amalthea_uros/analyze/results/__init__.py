"""What an analysis finds: of processes, chains and requirements, and of the whole system."""
