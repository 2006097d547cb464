"""Problems that make a model impossible to analyse, or its results misleading."""
