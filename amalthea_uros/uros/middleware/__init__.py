"""The middlewares: what is known of each one lies in its profile."""
