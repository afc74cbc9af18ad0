"""NC0xx: the text is not a part program block."""

from nccompile.codes.page import Page

__all__ = ["PAGES"]

PAGES: tuple[Page, ...] = (
    Page(
        "NC001",
        "unexpected character",
        "A block has words, comments in parentheses and blanks; nothing else. Often a decimal comma, a minus sign\n"
        "from a text processor, or a comment after a semicolon.",
        "% a\nN10 G1 X1,5 F20",
        "% a\nN10 G1 X1.5 F20",
    ),
    Page(
        "NC002",
        "letter without a number",
        "A word is a letter with its number directly after it (SoftMotion §3.2). A letter alone says nothing.",
        "% a\nN10 G1 X Y5 F20",
        "% a\nN10 G1 X10 Y5 F20",
    ),
    Page(
        "NC003",
        "malformed number",
        "Numbers have an optional sign and at most one point: 5 5. .5 -0.5. There is no exponent, because E is a\n"
        "word letter: X1E-05 could be read as X1 with a deceleration of 5.",
        "% a\nN10 G1 X1.2.3 F20\nN20 G1 X1e-05",
        "% a\nN10 G1 X1.23 F20\nN20 G1 X0.00001",
    ),
    Page(
        "NC004",
        "comment not closed, or nested",
        "Comments stand in parentheses on one line and cannot be nested (SoftMotion §3.2).",
        "% a\nN10 G1 X1 F20 (rough (first pass))",
        "% a\nN10 G1 X1 F20 (rough, first pass)",
    ),
    Page(
        "NC005",
        "malformed variable",
        "A variable is a name between two $: letters, digits, _ . [ ], starting with a letter (SoftMotion §3.2.3).",
        "% a\nN10 G36 O$g i$ D5",
        "% a\nN10 G36 O$g_i$ D5",
    ),
    Page(
        "NC006",
        "value without a word letter",
        "Each number and variable belongs to the letter before it.",
        "% a\nN10 G1 X1 5 F20",
        "% a\nN10 G1 X1 Y5 F20",
    ),
    Page(
        "NC007",
        "block number or / in the wrong place",
        "/ comes first in a block, then the block number N with a whole number, then the words (SoftMotion §3.2).",
        "% a\nN10 G1 X1 F20 N20 G1 X2",
        "% a\nN10 G1 X1 F20\nN20 G1 X2",
    ),
    Page(
        "NC008",
        "% after the start",
        "% starts a program (SoftMotion §3.2). A second one ends it: as the last line it has no meaning, before\n"
        "other lines it would start a second program in the same file, which is an error.",
        "% a\nN10 G1 X1 F20\n% b\nN10 G1 X2",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC009",
        "the program does not start with %",
        "A program starts with % and its name (SoftMotion §3.2). It is read without, but other controls refuse it.",
        "N10 G1 X1 F20",
        "% bracket\nN10 G1 X1 F20",
    ),
    Page(
        "NC010",
        "not a text file",
        "The file holds control characters that no program has: it is a queue, an archive, a picture, or text in\n"
        "UTF-16. Nothing of it is read.",
        "% a\nN10 G1 X1\x00 F20",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC011",
        "line too long",
        "A line has more than 65,536 characters. It is left out so that a damaged file cannot stall the compiler.",
    ),
    Page(
        "NC012",
        "no program",
        "The file has no block: it is empty, or holds a header and comments only.",
        "% a\n(nothing yet)",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC013",
        "word without a value",
        "Post-processors written in Python print None where they have no value. Such a word is left out.",
        "% a\nN10 G1 X1 YNone F20",
        "% a\nN10 G1 X1 F20",
    ),
    Page(
        "NC014",
        "reading stopped",
        "A thousand lines could not be read; the rest would say the same. The file is probably no part program.",
    ),
)
