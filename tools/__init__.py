"""What makers of the project run by hand."""
