"""Drives: what takes one set position an axis and cycle.  One file a kind; `protocol` says what they share."""
