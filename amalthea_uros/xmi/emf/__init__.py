"""The file format: XMI as EMF writes it, read and written without loss."""
