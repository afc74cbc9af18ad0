"""Pages of codes that the toolchain gives after decoding: their programs give them, or do not."""

import pytest

from nccompile.codes import correction
from nccompile.codes.page import Page
from nccompile.machine.model import default_machine
from nccompile.passes.option import parse
from nccompile.source import Source
from nccompile.toolchain import Compilation, Options

PAGES = [page for page in correction.PAGES if page.bad]


def _codes(page: Page, program: str) -> set[str]:
    passes = parse("" if page.code == "NC301" else "tool-radius,smooth-corners")
    compilation = Compilation(Source("a.nc", program), Options(default_machine(), passes=passes))
    assert sum(len(chunk) for chunk in compilation.planned()) > 0
    return {found.code for found in compilation.diagnostics}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.code)
def test_the_bad_program_gives_the_code(page: Page) -> None:
    assert page.code in _codes(page, page.bad)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.code)
def test_the_good_program_gives_no_finding(page: Page) -> None:
    assert _codes(page, page.good) == set()
