"""Importers: what is no part program (drawings, cam tables) becomes toolpaths and cam profiles."""
