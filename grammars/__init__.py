"""Grammar files of the part-program dialects; `nccompile.parser` loads them."""
