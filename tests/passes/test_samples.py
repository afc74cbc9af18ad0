"""Every sample program through every pass; `tests.passes.check_corpus` does the same with folders of real ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from nccompile.source import Source
from tests.passes.check_corpus import check
from tests.passes.every import EVERY, Turned

SAMPLES = sorted((Path(__file__).parents[2] / "samples").glob("*.nc"))


@pytest.mark.parametrize("turned", EVERY, ids=str)
def test_samples_take_every_pass(turned: Turned) -> None:
    reports = [check(Source.read(path), turned) for path in SAMPLES]
    assert any(report is not None for report in reports)
