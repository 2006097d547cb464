"""What jobs do: their activities in order, how often and in which jobs each one is executed."""
