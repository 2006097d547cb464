"""Chains that cross wires, the agent or executors in loops: from segment to segment, hop by hop."""
