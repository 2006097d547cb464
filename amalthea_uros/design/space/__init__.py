"""What may change of a system: values on offer, orders of priorities, and the rules that designs must keep."""
