"""Changes of a system: single values of its objects, written as `OBJECT.KEY=VALUE`."""
