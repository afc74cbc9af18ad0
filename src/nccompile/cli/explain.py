"""`nccompile explain`: the page of a diagnostic code."""

from __future__ import annotations

import difflib
from typing import Annotated

import typer

from nccompile.errors import UsageError

__all__ = ["explain"]


def explain(
    code: Annotated[str | None, typer.Argument(help="A code, e.g. NC201; none lists all.")] = None,
) -> None:
    """Print what a diagnostic code means, why it matters and what to write instead."""
    from nccompile.codes import PAGES

    if code is None:
        for page in PAGES.values():
            print(f"{page.code}  {page.title}")
        return
    page_of = PAGES.get(code.strip().upper())
    if page_of is None:
        near = difflib.get_close_matches(code.strip().upper(), PAGES, n=3)
        hint = f"; near it: {', '.join(near)}" if near else ""
        raise UsageError(f"there is no diagnostic code {code!r}{hint}; `nccompile explain` lists all")
    print(page_of)
