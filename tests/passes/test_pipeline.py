"""The -p option: mapping on parameters, bounds, order, suggestions; callbacks and times."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nccompile.errors import UsageError
from nccompile.passes.flatten import Flatten
from nccompile.passes.option import ORDER, parse
from nccompile.passes.transform import Transform
from nccompile.toolpath.columns import Toolpath
from tests.passes.paths import Sketch


def test_parameters_come_from_the_text() -> None:
    passes = parse(" transform{rotate=30, mirror=x},flatten{tolerance=0.01,arcs} ,compress").passes
    assert passes[0] == Transform(rotate=30.0, mirror="x")
    assert passes[1] == Flatten(tolerance=0.01, arcs=True)
    assert [p.name for p in passes] == ["transform", "flatten", "compress"]
    assert parse("flatten{arcs=yes,angle=5}").passes == (Flatten(angle=5.0, arcs=True),)
    assert parse("").passes == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("flaten{length=1}", "did you mean flatten"),
        ("flatten{lenght=1}", "did you mean length"),
        ("flatten{length=-1}", "flatten: length=-1 is out of bounds: 0 to 1e+06 mm"),
        ("flatten{length=abc}", "'abc' is not a number"),
        ("flatten{arcs=maybe,length=1}", "is not true or false"),
        ("flatten", "give length, angle or tolerance"),
        ("flatten{length=1,length=2}", "given twice"),
        ("flatten{length=1", "cannot read"),
        ("flatten{length=1},", "cannot read"),
        ("move-start", "segment is missing"),
        ("flatten{length=1},transform{x=1}", "transform must run before flatten"),
        ("reverse,reverse", "named twice"),
        ("round-corners{everywhere},smooth-corners{everywhere}", "cannot both act on the whole path"),
        ("tool-radius{everywhere},smooth-corners{everywhere}", "cannot both act on the whole path"),
        ("split{segment=1,line=2}", "either segment or line"),
    ],
)
def test_errors_say_what_to_do(text: str, words: str) -> None:
    with pytest.raises(UsageError) as caught:
        parse(text)
    assert words in str(caught.value)


def test_every_pass_has_one_name_spelt_like_its_class_and_module() -> None:
    for kind in ORDER:
        assert kind.name.replace("-", "_") == kind.__module__.rpartition(".")[2]
        assert "".join(word.title() for word in kind.name.split("-")) == kind.__name__


def test_callbacks_see_every_pass_and_reports_count() -> None:
    seen: list[tuple[str, int]] = []

    def watch(name: str, chunks: Iterator[Toolpath]) -> Iterator[Toolpath]:
        for chunk in chunks:
            seen.append((name, len(chunk)))
            yield chunk

    pipeline = parse("compress,flatten{length=1,arcs}")
    path = Sketch().to(1, 0).to(2, 0).arc(1.0, 3.0).path()
    out = Toolpath.join(list(pipeline.run([path], after=watch)))
    assert [sum(n for name, n in seen if name == which) for which in ("compress", "flatten")] == [2, 4]
    assert len(out) == 4
    compress, flatten = (r.as_dict() for r in pipeline.reports)
    assert (compress["segments_in"], compress["segments_out"], flatten["segments_out"]) == (3, 2, 4)
    assert compress["seconds"] >= 0.0
    assert flatten["seconds"] > 0.0
