"""What several rooms need and no user does: shipped files, compilation, garbage collection."""
