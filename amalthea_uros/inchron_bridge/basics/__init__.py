"""Shared by all tables: values, comments, the state of one run."""
