"""Random lines through the scanner and through the grammar's terminals: the same words, or a difference is shown.

    python -m benchmarks.fuzz_scanner --inputs 10000000 --seed 1

Lines are random sequences of pieces (letters, digits, signs, blanks, comments, odd characters), thousands in a
kernel call.  Every line is checked against a pattern made of the grammar's own terminals, and a sample of them
against Lark.  The seed gives the same lines again.
"""

from __future__ import annotations

import argparse
import io
import re
import sys
from time import perf_counter

import numpy as np

from nccompile.kernels import use
from nccompile.parser import Block, scanner
from nccompile.parser.grammar import line_parser
from nccompile.parser.lines import read_by_grammar
from nccompile.source import LargeSource

PIECES = [
    *"NGXYZFEIJRgxne", *"0123456789", *"0011", ".", ".", "-", "+", " ", " ", "\t", "\f", "(", ")", "(c)", "e-05",
    "E-200", "G1", "X1.5",
    "N10 ", "Y-.25 ", "X0.1", "F100 ", "12345678901234567", "000", "/", "%", "$a$",
    "None", ";", "ä", "\x0b",
]  # fmt: skip
LETTERS = "GXYZFEIJRABCxyzgm"
GAPS = ["", "", " ", " ", "  ", "\t", "\f", "(c)", " (d e) ", "()"]
ENDS = ["\n", "\r\n", "\r"]
BATCH = 50_000
LARK_EVERY = 200


def patterns() -> tuple[re.Pattern[str], re.Pattern[str]]:
    """What a plain line is, and its tokens, from the terminals of the grammar."""
    t = {terminal.name: terminal.pattern.to_regexp() for terminal in line_parser().terminals}
    gap = f"(?:{t['BLANK']}|{t['COMMENT']})*"
    line = rf"{gap}(?:{t['BLOCK_NUMBER']}{gap})?(?:{t['WORD']}{gap})*"
    return re.compile(line), re.compile(rf"{t['COMMENT']}|({t['BLOCK_NUMBER']}|{t['WORD']})")


def numbers(generator: np.random.Generator) -> list[str]:
    """Random spellings of numbers: signs, leading zeros, up to 40 digits, a point anywhere or none."""
    made = []
    for sign, length, point in generator.integers(0, 50, (1000, 3)).tolist():
        digits = "".join(
            map(str, generator.integers(0, 10, 1 + (length if length > 40 else length % 9)).tolist())
        )
        point %= 2 * len(digits)
        made.append(
            ("+", "-", "")[min(sign // 10, 2)]
            + digits[:point]
            + ("." if point <= len(digits) else "")
            + digits[point:]
        )
    return made


def batch(generator: np.random.Generator) -> list[str]:
    """Random lines: sequences of pieces, and words with gaps, every tenth with a piece between."""
    values = numbers(generator)
    lengths = generator.integers(0, 12, BATCH).tolist()
    picks = iter(generator.integers(0, 1 << 30, 3 * sum(lengths) + 2 * BATCH).tolist())
    lines = []
    for length in lengths:
        if next(picks) % 3 == 0:
            parts = [PIECES[next(picks) % len(PIECES)] for _ in range(length)]
        else:
            parts = [
                LETTERS[next(picks) % len(LETTERS)]
                + values[next(picks) % 1000]
                + GAPS[next(picks) % len(GAPS)]
                for _ in range(length // 2)
            ]
            pick = next(picks)
            if pick % 10 == 0:
                parts.insert(pick % (len(parts) + 1), PIECES[pick // 10 % len(PIECES)])
            if pick % 7 == 0:
                parts.insert(0, f"N{pick % 1000}")
        lines.append("".join(parts))
    return lines


def scan(data: bytes) -> dict[int, list[tuple[str, str]] | None]:
    """By line: letters and values of plain blocks, None for the others."""
    found: dict[int, list[tuple[str, str]] | None] = {}
    for table in scanner.tables(LargeSource("fuzz", io.BytesIO(data))):
        letters, values = table.letter[: table.words].tolist(), table.value[: table.words].tolist()
        first = table.block_word[: table.blocks + 1].tolist()
        plain = table.plain[: table.blocks].tolist()
        for b, line in enumerate(table.block_line[: table.blocks].tolist()):
            words = range(first[b], first[b + 1])
            found[line] = [(chr(letters[w]), repr(values[w])) for w in words] if plain[b] else None
    return found


def check(lines: list[str], end: str, line: re.Pattern[str], token: re.Pattern[str]) -> tuple[int, list[str]]:
    """How many lines were plain, and the differences."""
    found = scan(end.join(lines).encode())
    plain, wrong = 0, []
    for number, text in enumerate(lines, 1):
        words = found.get(number, [])
        expected: list[tuple[str, str]] | None = None
        if line.fullmatch(text):
            expected = [(w[0].upper(), repr(float(w[1:]))) for w in token.findall(text) if w]
        if words != expected and not (words == [] and not text.strip()):
            wrong.append(f"{text!r}: scanner {words}, grammar {expected}")
        plain += bool(words)
        if number % LARK_EVERY == 0 and words:
            node = read_by_grammar(1, text)
            tree = [*filter(None, [node.number]), *node.words] if isinstance(node, Block) else []
            if [(w.letter, repr(w.value)) for w in tree] != words:
                wrong.append(f"{text!r}: scanner {words}, tree {tree}")
    return plain, wrong


def main() -> int:
    """Runs the fuzzer; 1 if there was a difference."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--inputs", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    use(compiled=True)
    generator = np.random.default_rng(options.seed)
    line, token = patterns()
    begin, done, plain = perf_counter(), 0, 0
    while done < options.inputs:
        good, wrong = check(batch(generator), ENDS[done // BATCH % len(ENDS)], line, token)
        done, plain = done + BATCH, plain + good
        if wrong:
            print("\n".join(wrong[:20]))
            return 1
    seconds = perf_counter() - begin
    print(f"seed {options.seed}: {done:,} inputs, {plain:,} of them plain, no difference, {seconds:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
