"""Takes every .nc program of folders from text to drives, as test_spine does with the samples.

python -m tests.spine.check_corpus FOLDER|FILE..        cycle 4 ms, the built-in machine
"""

from __future__ import annotations

import sys
from pathlib import Path

from nccompile.source import Source
from tests.corpus import checked
from tests.spine.test_spine import GENERIC, check

MACHINE = GENERIC.model_copy(update={"identity": GENERIC.identity.model_copy(update={"cycle_us": 4000})})


def verdict(path: Path) -> str:
    check(Source.read(path), MACHINE)
    return "ok"


if __name__ == "__main__":
    sys.exit(checked(sys.argv[1:], verdict))
