"""NC7xx: the cyclic task and the drives."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = ()
