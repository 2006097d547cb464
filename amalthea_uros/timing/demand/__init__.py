"""How long the jobs of processes execute."""
