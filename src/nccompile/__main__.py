"""`python -m nccompile` is the `nccompile` command."""

from nccompile.cli.main import main

main()
