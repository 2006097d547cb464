"""The limits of a system: what is proved of the quantities that requirements and constraints limit."""
