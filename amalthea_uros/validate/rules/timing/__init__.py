"""What makes a model impossible to analyse, or its figures misleading."""
