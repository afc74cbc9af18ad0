"""The register of diagnostic codes: one page a code, printed by `nccompile explain`.

Codes by stage: NC0xx syntax, NC1xx modal state and words, NC2xx geometry, NC3xx correction and fitting,
NC4xx limits and safety areas, NC5xx dynamics, NC6xx import, NC7xx runtime and drives.  A code is never used
again; the module of a stage holds its pages.  Codes from NCx50 on are those of the linter.
"""

from __future__ import annotations

from nccompile.codes import (
    correction,
    dynamics,
    geometry,
    imports,
    limits,
    lint_rules,
    runtime,
    syntax,
    words,
)
from nccompile.codes.page import Page

__all__ = ["PAGES", "Page"]

PAGES: dict[str, Page] = {
    page.code: page
    for page in sorted(
        (
            page
            for stage in (syntax, words, geometry, correction, limits, dynamics, imports, runtime, lint_rules)
            for page in stage.PAGES
        ),
        key=lambda page: page.code,
    )
}
"""All pages by code, in the order of the codes."""
