"""Runs all benchmarks: `python -m benchmarks`, or those named, as in `python -m benchmarks startup`."""

from __future__ import annotations

import sys
from importlib import import_module

NAMES = (
    "startup",
    "compile",
    "front_end",
    "queue",
    "runtime",
    "planner",
    "lint",
    "lsp",
    "passes",
    "dxf",
    "toppra",
)


def main() -> int:
    """Runs the benchmarks named on the command line, or all."""
    names = sys.argv[1:] or NAMES
    for name in names:
        if name not in NAMES:
            print(f"no benchmark {name!r}; there are {', '.join(NAMES)}", file=sys.stderr)
            return 2
        import_module(f"benchmarks.bench_{name}").main()
    return 0


sys.exit(main())
