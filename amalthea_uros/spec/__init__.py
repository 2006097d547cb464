"""The text of an `app.yaml` as a typed description, in which each value knows its location: hardware, middleware, application."""
