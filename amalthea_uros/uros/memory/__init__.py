"""What an application needs of memory: entities of the middleware, stacks, and all of it against what the board has."""
