"""Priorities with which all tasks of a core meet their deadlines."""
