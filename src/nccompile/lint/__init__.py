"""The linter and the formatter: rules over the program and its toolpath, safe fixes, block numbers.

`lint` gives what `compile` reports and what the rules add, as the same Diagnostics.
"""
