"""What APP4MC reports when it validates a model, under its own ids (AM), and what its documentation asks for (DOC)."""
