"""Better designs: changes of a system, variants of it, searches, and the source with the changes."""
