"""NC1xx: modal state, words, variables and jumps."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = ()
