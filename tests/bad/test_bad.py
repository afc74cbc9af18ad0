"""Bad programs and the exact text of what is said about them.

Dropping `name.nc` and `name.expected` here adds a test.
"""

from pathlib import Path

import pytest

from nccompile.decoder import DecodeOptions, decode
from nccompile.diagnostics import Diagnostics, render
from nccompile.source import Source

FOLDER = Path(__file__).parent


@pytest.mark.parametrize("program", sorted(FOLDER.glob("*.nc")), ids=lambda path: path.stem)
def test_findings_read_as_expected(program: Path) -> None:
    source = Source.from_bytes(program.name, program.read_bytes())
    diagnostics = Diagnostics()
    for _ in decode(source, DecodeOptions(), diagnostics):
        pass
    shown = "\n".join(render(found, source) for found in diagnostics) + "\n"
    assert shown == program.with_suffix(".expected").read_text(encoding="utf-8")
