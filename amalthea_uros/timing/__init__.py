"""The timing semantics of a system: scheduling, execution demand, activations and data flow; it contains no methods of analysis."""
