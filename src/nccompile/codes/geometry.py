"""NC2xx: geometry that cannot be or was replaced."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = ()
