"""The passes are tested with compiled kernels: fits and measurements of some thousand samples need them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nccompile import kernels


@pytest.fixture(autouse=True)
def _compiled() -> Iterator[None]:
    before = kernels.compiled()
    kernels.use(compiled=True)
    yield
    kernels.use(compiled=before)
