"""The middlewares: what the model, the checks and the pools ask of one is in its profile."""
