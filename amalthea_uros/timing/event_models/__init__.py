"""Event models: how many events can occur in a window, and how close together they can be."""
