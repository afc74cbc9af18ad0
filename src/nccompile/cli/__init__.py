"""The command line: one file a subcommand; `main` is the entry point."""
