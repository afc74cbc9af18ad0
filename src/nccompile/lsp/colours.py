"""The semantic tokens that were sent last, so that after an edit their difference is enough.

A document of 50,000 lines has a million numbers; an edit changes a few of them.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from lsprotocol import types

from nccompile.lsp.features.tokens import difference

__all__ = ["Colours"]


class Colours:
    """By document: the name of the last answer and its numbers."""

    def __init__(self) -> None:
        self._sent: dict[str, tuple[str, npt.NDArray[np.int32]]] = {}
        self._count = 0

    def forget(self, uri: str) -> None:
        """A document was closed."""
        self._sent.pop(uri, None)

    def full(self, uri: str, numbers: list[int]) -> types.SemanticTokens:
        """All tokens of a document."""
        self._count += 1
        name = str(self._count)
        self._sent[uri] = name, np.array(numbers, np.int32)
        return types.SemanticTokens(numbers, name)

    def since(
        self, uri: str, before: str, numbers: list[int]
    ) -> types.SemanticTokens | types.SemanticTokensDelta:
        """What makes the tokens of the answer `before` the ones given; all of them if that was not the last."""
        name, old = self._sent.get(uri, ("", None))
        whole = self.full(uri, numbers)
        if old is None or name != before:
            return whole
        return types.SemanticTokensDelta(difference(old, self._sent[uri][1]), whole.result_id)
