"""Transports between the controller and the agent: what a message is on each kind of wire, and what it passes on its way."""
