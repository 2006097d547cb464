"""The application of a description: its callbacks, what serves them, the entities that they create, and findings."""
