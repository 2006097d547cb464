"""Files of models: reading, writing, checking."""
