"""Results as Markdown: each has a module with the name of its class."""
