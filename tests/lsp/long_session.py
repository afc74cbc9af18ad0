"""A session of any length: two documents in one server, random edits, compared with `lint` and with a fresh server.

python -m tests.lsp.long_session MINUTES [SEED]
"""

from __future__ import annotations

import sys
import time

from tests.lsp.client import serving
from tests.lsp.test_session import Writer, without_data

STEPS = 40
START = "% a\nN10 G1 X1 F20\nN20 G1 X2\n"


def main(minutes: float, seed: int) -> None:
    end = time.monotonic() + 60.0 * minutes
    edits = comparisons = 0
    with serving() as client:
        writers = [
            Writer(client, f"untitled:{name}", START, seed + at) for at, name in enumerate(("one", "two"))
        ]
        while time.monotonic() < end:
            for _ in range(STEPS):
                for writer in writers:
                    writer.step()
            edits += STEPS * len(writers)
            with serving() as fresh:
                for writer in writers:
                    assert writer.shown() == writer.expected(), writer.text
                    fresh.open(writer.uri, writer.text)
                    assert without_data(fresh.checked(writer.uri)) == without_data(client.checked(writer.uri))
                    comparisons += 1
                    del writer.past[:-200]
            client.notifications = [m for m in client.notifications if m["method"] == "nccompile/checked"][
                -4:
            ]
            for writer in writers:  # a file may grow by pastes only so far
                if len(writer.text) > 200_000:
                    writer.whole(START)
    print(f"{minutes:g} minutes: {edits} edits, {comparisons} comparisons, no difference")


if __name__ == "__main__":
    main(float(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 0)
