"""Takes every .nc program of folders from text to drives, as test_spine does with the samples.

python -m tests.spine.check_corpus FOLDER..        cycle 4 ms, the built-in machine
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from nccompile.source import Source
from tests.spine.test_spine import GENERIC, check


def main(folders: list[str]) -> int:
    machine = GENERIC.model_copy(update={"identity": GENERIC.identity.model_copy(update={"cycle_us": 4000})})
    failed = 0
    for path in sorted(p for folder in folders for p in Path(folder).glob("*.nc")):
        begin = time.perf_counter()
        try:
            check(Source.read(path), machine)
            verdict = "ok"
        except AssertionError as error:
            failed += 1
            verdict = f"FAILED {error}"
        print(f"{path.name:30} {time.perf_counter() - begin:8.1f} s  {verdict}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
