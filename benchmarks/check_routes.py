"""Both routes of the front end on the programs of a folder and on damaged copies of them.

    python -m benchmarks.check_routes FOLDER --copies 20 --seed 1

Toolpaths must be the same bit for bit, findings word for word.  Damage: bytes changed, lines cut, merged, doubled.
"""

from __future__ import annotations

import argparse
import random
import sys
from pathlib import Path

from nccompile.kernels import use
from tests.scanner.routes import compare, damaged

PARTS = (1 << 20, 4096, 999)


def main() -> int:
    """Checks all programs; an AssertionError names the first difference."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--copies", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    use(compiled=True)
    generator = random.Random(options.seed)
    segments = findings = checks = 0
    for file in sorted(p for p in options.folder.rglob("*") if p.is_file()):
        data = file.read_bytes()
        for copy in range(options.copies + 1):
            path, found = compare(damaged(data, generator) if copy else data, PARTS[copy % len(PARTS)])
            segments, findings, checks = segments + len(path), findings + len(found), checks + 1
        print(f"{file.name}: the same", flush=True)
    print(f"{checks} programs, {segments:,} segments, {findings:,} findings, no difference")
    return 0


if __name__ == "__main__":
    sys.exit(main())
