"""What the tables are made of: entries for classes, codecs for values, and the state of a run."""
