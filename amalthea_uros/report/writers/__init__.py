"""Documents as text for terminals, as HTML, and as Markdown."""
