"""The rules, by profile."""
