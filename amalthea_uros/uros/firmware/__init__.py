"""The part of the firmware that follows from a description: entities, executors, loops and threads as C."""
