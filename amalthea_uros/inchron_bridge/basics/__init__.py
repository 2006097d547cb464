"""What all tables need: values, comments, the state of one run."""
