"""One file a rule; the docstring of its class is its page."""
