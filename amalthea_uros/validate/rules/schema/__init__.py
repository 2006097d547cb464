"""The XML schema of the AMALTHEA version of a model."""
