"""Path point to axis positions and back; one file a machine kind."""
