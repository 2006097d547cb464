"""INCHRON projects: typed objects by the facts of the metamodel, and the reading and writing of `.iprx` files."""
