"""NC5xx: feeds, accelerations and velocity planning."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = ()
