"""New studies and laws, written from templates."""
