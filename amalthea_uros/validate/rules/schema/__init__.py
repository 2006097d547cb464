"""What the XML schema of a model's version says."""
