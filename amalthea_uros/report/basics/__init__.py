"""What everything in this room needs: the parts of a document, harmless text, and how the user wants to see it."""
