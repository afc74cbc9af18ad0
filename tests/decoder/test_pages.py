"""Each page of a code shows a program that gives it and one that does not."""

import pytest

from nccompile.codes import geometry, syntax, words
from nccompile.codes.page import Page
from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics
from nccompile.source import Source

PAGES = [page for module in (syntax, words, geometry) for page in module.PAGES if page.bad]


def codes(program: str) -> set[str]:
    diagnostics = Diagnostics()
    for _ in decode(Source("a.nc", program), DecodeOptions(), diagnostics):
        pass
    return {found.code for found in diagnostics}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.code)
def test_the_bad_program_gives_the_code(page: Page) -> None:
    assert page.code in codes(page.bad)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.code)
def test_the_good_program_gives_no_finding(page: Page) -> None:
    assert codes(page.good) == set()
