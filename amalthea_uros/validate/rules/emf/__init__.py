"""What EMF checks of every model, from the facts of the metamodel, and what its classes demand of themselves."""
