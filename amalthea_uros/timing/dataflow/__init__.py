"""Where jobs do what, which events that makes, and what links one event to another."""
