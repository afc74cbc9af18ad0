"""Random DIN 66025 programs that use the whole language, as text."""

from __future__ import annotations

from math import cos, pi, sin

from hypothesis import strategies as st

ANGLES = st.integers(0, 359)
FEEDS = st.sampled_from(["", " F5", " F30", " F120", " F400"])
RAMPS = st.sampled_from(["", " E300", " E2000 E-1000", " E-150"])
CURVES = ["arc", "ellipse", "parabola", "spline"]
STILL = ["dwell", "m", "jump", "loop"]
SWITCHES = st.sampled_from(["", "", "", " H1 O0.25", " H3 L2 H-1 O1", " H-2 O0 H2 L-1"])


def num(value: float) -> str:
    """A coordinate as a post-processor writes it."""
    return f"{value:.4f}"


class Writer:
    """Writes blocks and knows the position, so that arcs and ellipses are consistent."""

    def __init__(self) -> None:
        self.lines = ["% RANDOM", "N1 G92 X0 Y0 Z0", "N2 G90"]
        self.x = self.y = self.z = 0.0

    def put(self, text: str) -> None:
        """Appends a block with its number."""
        self.lines.append(f"N{10 * len(self.lines)} {text}")

    def line(self, angle: int, length: float, words: str, g: str = "G1") -> None:
        """A straight move by angle [deg] and length."""
        self.x = round(self.x + length * cos(angle * pi / 180), 4)
        self.y = round(self.y + length * sin(angle * pi / 180), 4)
        self.put(f"{g} X{num(self.x)} Y{num(self.y)}{words}")

    def arc(self, angle: int, radius: float, full: bool, dz: float, words: str, g: str) -> None:
        """A half or full circle, its centre in direction `angle`; with dz a helix."""
        i, j = round(radius * cos(angle * pi / 180), 4), round(radius * sin(angle * pi / 180), 4)
        if not full:
            self.x, self.y = round(self.x + 2 * i, 4), round(self.y + 2 * j, 4)
        self.z = round(self.z + dz, 4)
        z = f" Z{num(self.z)}" if dz else ""
        self.put(f"{g} X{num(self.x)} Y{num(self.y)}{z} I{num(i)} J{num(j)}{words}")

    def ellipse(self, angle: int, half: float, ratio: float, words: str, g: str) -> None:
        """Half an ellipse from one main vertex to the other."""
        i, j = round(half * cos(angle * pi / 180), 4), round(half * sin(angle * pi / 180), 4)
        self.x, self.y = round(self.x + 2 * i, 4), round(self.y + 2 * j, 4)
        self.put(f"{g} X{num(self.x)} Y{num(self.y)} I{num(i)} J{num(j)} K{angle} R{ratio}{words}")

    def parabola(self, angle: int, length: float, words: str) -> None:
        """A parabola whose tangents meet ahead."""
        i, j = length * cos(angle * pi / 180), length * sin(angle * pi / 180)
        self.x, self.y = round(self.x + i - 0.7 * j, 4), round(self.y + j + 0.7 * i, 4)
        self.put(f"G6 X{num(self.x)} Y{num(self.y)} I{num(i)} J{num(j)}{words}")


def _curve(draw: st.DrawFn, w: Writer, kind: str, angle: int, words: str) -> None:
    """A segment that is not straight."""
    if kind == "arc":
        radius, dz = draw(st.sampled_from([0.5, 4.0, 20.0])), draw(st.sampled_from([0.0, -2.5]))
        w.arc(angle, radius, draw(st.booleans()), dz, words, draw(st.sampled_from(["G2", "G3"])))
    elif kind == "ellipse":
        half, ratio = draw(st.sampled_from([2.0, 15.0])), draw(st.sampled_from([0.05, 0.5, 1.0]))
        w.ellipse(angle, half, ratio, words, draw(st.sampled_from(["G8", "G9"])))
    elif kind == "parabola":
        w.parabola(angle, draw(st.sampled_from([3.0, 15.0])), words)
    else:
        for turn in (0, 40, -35):
            w.line(angle + turn, 12.0, words, "G5")


def _straight(draw: st.DrawFn, w: Writer, kind: str, angle: int, words: str) -> None:
    """A straight segment: feed move, rapid, additional axes, Z in the S-profile, relative."""
    if kind in ("G0", "G1"):
        length = draw(st.sampled_from([0.01, 3.0, 25.0]))
        w.line(angle, length, words + (draw(SWITCHES) if length > 2 else ""), kind)
    elif kind == "additional":
        w.put(f"G1 A{draw(st.integers(-90, 90))} P{draw(st.integers(-20, 20))}{words}")
    elif kind == "profile":
        w.put("S3")
        w.z = round(w.z + draw(st.sampled_from([-3.0, 4.0])), 4)
        w.line(angle, 20.0, f" Z{num(w.z)}{words}")
        w.put("S-3")
    else:
        w.put("G91")
        w.put(f"G1 Z-1{words}")
        w.z = round(w.z - 1, 4)
        w.put("G90")


def _still(w: Writer, kind: str) -> None:
    """A dwell, an M function, a jump of the position, a loop."""
    if kind == "dwell":
        w.put("G4 T0.05")
    elif kind == "m":
        w.put("M7 K1.5 L2")
    elif kind == "jump":
        w.x = round(w.x + 7.5, 4)
        w.put(f"G92 X{num(w.x)}")
    else:
        w.put("G36 D3")
        at = 10 * len(w.lines)
        for block in ("G91", "G1 X2 Y1", "G90", "G37 D-1", f"G20 L{at}"):
            w.put(block)
        w.x, w.y = round(w.x + 6, 4), round(w.y + 3, 4)


@st.composite
def programs(draw: st.DrawFn, most: int = 14) -> str:
    """A program that compiles without errors on the built-in machine."""
    w = Writer()
    for _ in range(draw(st.integers(1, most))):
        kind = draw(st.sampled_from(["G1", "G1", "G0", "additional", "profile", "relative", *CURVES, *STILL]))
        words = draw(FEEDS) + draw(RAMPS)
        if kind in CURVES:
            _curve(draw, w, kind, draw(ANGLES), words)
        elif kind in STILL:
            _still(w, kind)
        else:
            _straight(draw, w, kind, draw(ANGLES), words)
    return "\n".join(w.lines) + "\n"
