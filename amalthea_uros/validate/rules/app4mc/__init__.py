"""What APP4MC reports when it validates a model, under its own ids."""
