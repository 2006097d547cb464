"""Event models: bounds on how often something happens."""
