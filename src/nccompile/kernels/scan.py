"""Program bytes to word columns: the part of the grammar that nearly all blocks are made of.

    N10 G1 X1.5 Y-.25 (finish)          one row a block: line, place, words first..last
    |   |  |    |                       one row a word: letter, value, place

A block is plain if it is a block number and words of a letter and a number, with blanks and comments between
them in any way the grammar allows.  Everything else (headers, `/`, variables, words without value, whatever is
wrong) is marked as not plain and left to the grammar.  Lines that hold blanks or comments only give no block.

Values are exact: up to 2^53 a decimal mantissa is a float, powers of ten up to 10^22 are floats, and one
division rounds correctly.  Longer numbers are listed as hard and left to `float`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from nccompile.kernels import kernel

__all__ = ["LETTER_N", "MOST_BYTES", "POWERS", "scan", "survey"]

Bytes = npt.NDArray[np.int8]
Flags = npt.NDArray[np.uint8]
Ints = npt.NDArray[np.int32]
Longs = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

MOST_BYTES = 65_536
"""Longest plain line; longer ones are not plain, and mostly refused."""

POWERS = np.array([float(f"1e{n}") for n in range(23)])
"""10^0 to 10^22, all exact."""

_EXACT = 9007199254740992  # 2^53
_DIGITS = 18  # so many digits fit an int64
_TAB, _LF, _VT, _FF, _CR, _BLANK, _OPEN, _CLOSE, _PLUS, _MINUS, _POINT = (
    9,
    10,
    11,
    12,
    13,
    32,
    40,
    41,
    43,
    45,
    46,
)
_ZERO, _NINE = 48, 57
LETTER_N = 78
"""The letter of block numbers, as all letters here in upper case."""


@kernel
def scan(
    data: Bytes, begin: int, end: int, line: int, powers: Floats,
    block_line: Ints, block_begin: Ints, block_end: Ints, block_word: Ints, plain: Flags,
    letter: Flags, value: Floats, place: Ints, hard: Ints, counts: Longs,
) -> int:  # fmt: skip
    """Scans the lines of data[begin:end], the last of which may lack its end; returns the place after those it took.

    Args:     data: Shape (bytes,), signed so that all arithmetic is;  line: number of the first line;
              powers: `POWERS`.
    Writes:   a row a block: line, place of the line and of its end (without the line end), row of its first
              word, whether it is plain; block_word has one more row.  A row a word: letter in upper case, value,
              place of the letter.  hard: the words whose value is left to `float`.
              counts: blocks, words, hard words, number of the next line.
    Limits:   stops in front of a line that the tables cannot take; they need MOST_BYTES words at least.
    """
    blocks = 0
    words = 0
    hards = 0
    most_blocks = len(block_line)
    most_words = len(letter)
    i = begin
    start = begin
    block_word[0] = 0
    while True:
        start = i
        first = words
        first_hard = hards
        good = True
        if i >= end or blocks >= most_blocks or words >= most_words:
            break
        while i < end:
            c = int(data[i])
            if c == _BLANK or c == _TAB or c == _FF or c == _VT:
                i += 1
                continue
            lower = c | 32
            if 97 <= lower <= 122:
                at = i
                name = lower - 32
                i += 1
                if words >= most_words or hards >= len(hard) or i - start > MOST_BYTES:
                    good = False
                    break
                negative = False
                if name == LETTER_N:
                    if words > first:
                        good = False
                        break
                elif i < end:
                    c = int(data[i])
                    if c == _MINUS:
                        negative = True
                        i += 1
                    elif c == _PLUS:
                        i += 1
                mantissa = 0
                from_digit = i
                while i < end:
                    c = int(data[i]) - _ZERO
                    if c < 0 or c > 9:
                        break
                    mantissa = mantissa * 10 + c
                    i += 1
                digits = i - from_digit
                behind = 0
                if i < end and int(data[i]) == _POINT:
                    if name == LETTER_N:
                        good = False
                        break
                    i += 1
                    from_digit = i
                    while i < end:
                        c = int(data[i]) - _ZERO
                        if c < 0 or c > 9:
                            break
                        mantissa = mantissa * 10 + c
                        i += 1
                    behind = i - from_digit
                    digits += behind
                    if i < end and int(data[i]) == _POINT:
                        good = False
                        break
                if digits == 0:
                    good = False
                    break
                if name != LETTER_N and i + 3 < end and int(data[i]) | 32 == 101:
                    c = int(data[i + 1])
                    if (
                        (c == _PLUS or c == _MINUS)
                        and _ZERO <= int(data[i + 2]) <= _NINE
                        and _ZERO <= int(data[i + 3]) <= _NINE
                        and not (i + 4 < end and _ZERO <= int(data[i + 4]) <= _NINE)
                    ):
                        good = False
                        break
                if digits <= _DIGITS and mantissa <= _EXACT:
                    number = mantissa / powers[behind]
                else:
                    number = 0.0
                    hard[hards] = words
                    hards += 1
                letter[words] = name
                value[words] = -number if negative else number
                place[words] = at
                words += 1
            elif c == _LF or c == _CR:
                break
            elif c == _OPEN:
                i += 1
                while i < end:
                    c = int(data[i])
                    if c == _CLOSE or c == _OPEN or c == _LF or c == _CR:
                        break
                    i += 1
                if i >= end or c != _CLOSE:
                    good = False
                    break
                i += 1
            else:
                good = False
                break
        if not good or i - start > MOST_BYTES:
            good = False
            if first > 0 and (words >= most_words or hards >= len(hard)):
                words = first
                hards = first_hard
                break  # the line may well be plain: it comes first in the next tables
            words = first
            hards = first_hard
            while i < end:
                c = int(data[i])
                if c == _LF or c == _CR:
                    break
                i += 1
        stop = i
        if i < end:
            i += 2 if int(data[i]) == _CR and i + 1 < end and int(data[i + 1]) == _LF else 1
        if not good or words > first:
            block_line[blocks] = line
            block_begin[blocks] = start
            block_end[blocks] = stop
            plain[blocks] = 1 if good else 0
            blocks += 1
            block_word[blocks] = words
        line += 1
    counts[0] = blocks
    counts[1] = words
    counts[2] = hards
    counts[3] = line
    return start


@kernel
def survey(data: Bytes, end: int, found: Longs, wanted: Flags) -> int:
    """Looks over data[:end], whole lines (the last one may lack its end), for what must be known beforehand.

    Args:     wanted: Shape (128,), 1 for the upper-case letters of axes whose words are looked for.
    Writes:   found[0] = 1: a byte above 127;  found[1] = 1: a jump may be there (G20 or G$ anywhere, comments
              too);  found[2 + letter - 65]: 1 for a wanted letter with a value outside comments and headers.
    Returns:  the place of the first control character that no program has, or -1.
    """
    i = 0
    fresh = True
    close = -1
    while i < end:
        c = int(data[i])
        i += 1
        if c == _BLANK or (_PLUS <= c <= _NINE):
            fresh = fresh and c == _BLANK
            continue
        if c < _BLANK:
            if c < 0:
                found[0] = 1
                fresh = False
            elif c == _LF or c == _CR:
                fresh = True
            elif c < _TAB or c > _CR:
                return i - 1
            elif c != _TAB:
                fresh = False
            continue
        if c == 127:
            return i - 1
        lower = c | 32
        if lower == 103:
            _look_for_jump(data, i, end, found)
        if i > close:  # not inside a comment, a variable or a header
            if 97 <= lower <= 122:
                if wanted[lower - 32] == 1 and i < end:
                    c = int(data[i])
                    if c == _PLUS or c == _MINUS or c == _POINT or _ZERO <= c <= _NINE or c == 36:
                        found[2 + lower - 97] = 1
            elif c == _OPEN:
                close = _closing(data, i, end)
            elif c == 36:
                close = _second_dollar(data, i, end)
            elif c == 37 and fresh:
                close = _line_end(data, i, end)
        fresh = False
    return -1


@kernel
def _look_for_jump(data: Bytes, i: int, end: int, found: Longs) -> None:
    """found[1] = 1 if 0*20 and no digit, or $, stands at i."""
    if i < end and int(data[i]) == 36:
        found[1] = 1
    while i < end and int(data[i]) == _ZERO:
        i += 1
    if (
        i + 1 < end
        and int(data[i]) == 50
        and int(data[i + 1]) == _ZERO
        and not (i + 2 < end and _ZERO <= int(data[i + 2]) <= _NINE)
    ):
        found[1] = 1


@kernel
def _closing(data: Bytes, i: int, end: int) -> int:
    """The place after the parenthesis that closes a comment; -1 if it is not one."""
    while i < end:
        c = int(data[i])
        i += 1
        if c == _CLOSE:
            return i
        if c == _OPEN or c == _LF or c == _CR:
            return -1
    return -1


@kernel
def _second_dollar(data: Bytes, i: int, end: int) -> int:
    """The place after the next $ of the line; -1 if there is none."""
    while i < end:
        c = int(data[i])
        i += 1
        if c == 36:
            return i
        if c == _LF or c == _CR:
            return -1
    return -1


@kernel
def _line_end(data: Bytes, i: int, end: int) -> int:
    """The place of the line's end."""
    while i < end and int(data[i]) != _LF and int(data[i]) != _CR:
        i += 1
    return i
