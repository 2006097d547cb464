"""The search for better designs: what may change, what must hold, what is better."""
