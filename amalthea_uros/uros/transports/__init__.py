"""Transports between the controller and the agent: what a message is on each kind of wire, and how long it takes."""
