"""The network of a description in its system: wires, what is queued on them, and what receives in the controller."""
