"""When processes are activated, and the load of the cores that follows."""
