"""The ways of messages: chains that cross wires, the agent or executors that loop, hop by hop."""
