"""Results as text: a module for each, named by the class of the result."""
