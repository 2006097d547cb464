"""Values of an `app.yaml` changed in its text: comments, layout and everything else stay as they are."""
