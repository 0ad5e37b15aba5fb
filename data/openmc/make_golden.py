#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""Writes golden.json: the volumes of the models' cells and materials by closed forms.

--check: writes nothing, exit 1 if it would change. Every form was derived by hand from what
make_models.py says of a model, and is written beside its value; nothing here computes a volume in
any other way. Rational volumes are exact; others are rounded outwards to 20 digits, computed with
60. Materials are the sums of the cells that name them in the model's file. Overlaps count in full
for each cell, gaps for none.
"""
import decimal
import json
import math
import pathlib
import sys
import xml.etree.ElementTree as ElementTree
from fractions import Fraction

HERE = pathlib.Path(__file__).resolve().parent
DIGITS = 20
decimal.getcontext().prec = 60


class Number:
    """A rational number, or a Decimal of 60 digits as soon as something irrational comes in."""

    def __init__(self, value):
        self.value = value if isinstance(value, (Fraction, decimal.Decimal)) else Fraction(value)

    @staticmethod
    def of(value):
        return value if isinstance(value, Number) else Number(value)

    def real(self):
        if isinstance(self.value, decimal.Decimal):
            return self.value
        return decimal.Decimal(self.value.numerator) / decimal.Decimal(self.value.denominator)

    def combined(self, other, operation):
        other = Number.of(other)
        if isinstance(self.value, Fraction) and isinstance(other.value, Fraction):
            return Number(operation(self.value, other.value))
        return Number(operation(self.real(), other.real()))

    def __add__(self, other):
        return self.combined(other, lambda a, b: a + b)

    def __sub__(self, other):
        return self.combined(other, lambda a, b: a - b)

    def __mul__(self, other):
        return self.combined(other, lambda a, b: a * b)

    def __truediv__(self, other):
        return self.combined(other, lambda a, b: a / b)

    def __rsub__(self, other):
        return Number.of(other) - self

    __radd__ = __add__
    __rmul__ = __mul__

    def __neg__(self):
        return Number(0) - self

    def bounds(self, slack):
        """Text: the number, or two of them."""
        if isinstance(self.value, Fraction) and not slack:
            return str(self.value)
        exponent = self.real().adjusted() - DIGITS + 1
        unit = decimal.Decimal(1).scaleb(exponent)
        margin = abs(self.real()) * slack
        lower = (self.real() - margin).quantize(unit, decimal.ROUND_FLOOR)
        upper = (self.real() + margin).quantize(unit, decimal.ROUND_CEILING)
        return [str(lower), str(upper)]


def square_root(value):
    return Number(Number.of(value).real().sqrt())


def arc_tangent(value):
    """Halved until the series is quick."""
    x = Number.of(value).real()
    factor = 1
    while abs(x) > decimal.Decimal("0.01"):
        x = x / (1 + (1 + x * x).sqrt())
        factor *= 2
    term, total, n = x, x, 1
    while abs(term) > abs(x).scaleb(-70):
        term *= -x * x
        n += 2
        total += term / n
    return Number(total * factor)


def arc_cosine(value):
    value = Number.of(value)
    return 2 * arc_tangent(square_root((1 - value) / (1 + value)))


PI = 4 * arc_tangent(1)


def dec(text):
    return Number(Fraction(text))


def disc(radius):
    return PI * dec(radius) * dec(radius)


def ball(radius):
    return Fraction(4, 3) * PI * dec(radius) * dec(radius) * dec(radius)


MODELS = {}
ROUNDED_ROTATION = decimal.Decimal("1e-12")  # the matrix is one of doubles


def model(name, *cells, slack=0):
    """cells: (number, volume or None, form)"""
    MODELS[name] = (cells, slack)


def pin(height, pitch, missing_gap=False):
    fuel, inside, outside = (height * disc(r) for r in ("0.4096", "0.418", "0.475"))
    square = height * dec(pitch) * dec(pitch)
    cells = [(1, fuel, "h pi 0.4096^2"), (2, inside - fuel, "h pi (0.418^2 - 0.4096^2)"),
             (3, outside - inside, "h pi (0.475^2 - 0.418^2)"),
             (4, square - outside, f"h ({pitch}^2 - pi 0.475^2)")]
    return [c for c in cells if not (missing_gap and c[0] == 2)]


def of_height(cells, height, count=1):
    return [(number, count * volume, (f"{count} " if count > 1 else "") + f"{form}, h = {height}")
            for number, volume, form in cells]


def pin_cells():
    model("pin_cell", *of_height(pin(20, "1.26"), 20))
    model("pin_cell_leak", *of_height(pin(20, "1.26"), 20))
    model("pin_cell_missing_cell", *of_height(pin(20, "1.26", missing_gap=True), 20))
    for name, pitch in (("assembly_17x17", "1.26"), ("assembly_17x17_wrong_pitch", "1.25")):
        inside, outside = 366 * disc("0.561"), 366 * disc("0.602")
        square = 366 * dec(pitch) * dec(pitch)
        model(name, *of_height(pin(366, pitch), 366, 264),
              (5, 25 * inside, "25 h pi 0.561^2, h = 366"),
              (6, 25 * (outside - inside), "25 h pi (0.602^2 - 0.561^2), h = 366"),
              (7, 25 * (square - outside), f"25 h ({pitch}^2 - pi 0.602^2), h = 366"),
              (10, 366 * dec("21.42") * dec("21.42"), "366 * 21.42^2"))
    one = 366 * disc("0.475")
    box = 366 * dec("21.42") * dec("21.42")
    pins = [(number, one, "366 pi 0.475^2") for number in range(1, 290)]
    model("assembly_17x17_flat", *pins, (1000, box - 289 * one, "366 (21.42^2 - 289 pi 0.475^2)"))
    # Two discs of radius r whose centres are d apart: 2 r^2 arccos(d / (2 r)) - d/2 sqrt(4 r^2 - d^2).
    r, d = dec("0.475"), dec("0.949999")
    lens = 366 * (2 * r * r * arc_cosine(d / (2 * r)) - d / 2 * square_root(4 * r * r - d * d))
    model("assembly_17x17_overlap", *pins,
          (1000, box - 289 * one + lens,
           "366 (21.42^2 - 289 pi 0.475^2 + the lens of two discs 0.949999 apart)"))
    model("two_dimensional_pin", (1, None, "no end along z"), (2, None, "no end along z"))


def hexagons():
    # Half the root of three as the nearest double: an element of pitch p has the area s p^2.
    s = Number(Fraction(math.sqrt(3) / 2))
    rods = 7 * 2 * disc("0.4")
    model("hexagonal_without_outer", (1, rods, "7 * 2 pi 0.4^2"),
          (2, 14 * s - rods, "7 * 2 (s - pi 0.4^2), s = sqrt(3)/2 as a double"), (10, Number(32), "4 * 4 * 2"))
    # Pins and their elements reach 3.82 towards the sides of an assembly, which are at 4.25; assemblies 21.9
    # from the axis: nothing is cut.
    pins, elements = 19 * 37 * 100 * disc("0.4"), 19 * 37 * 100 * dec("1.44") * s
    model("hexagonal_core", (1, pins, "19 * 37 * 100 pi 0.4^2"),
          (2, elements - pins, "19 * 37 * 100 (1.2^2 s - pi 0.4^2), s = sqrt(3)/2 as a double"),
          (3, 62500 * PI - elements, "100 pi 25^2 - 19 * 37 * 100 * 1.2^2 s"),
          (4, 1900 * dec("72.25") * s, "19 * 100 * 8.5^2 s"), (5, 62500 * PI, "100 pi 25^2"))
    pin_in_prism = 288 * PI
    # The width at y is (35 - 3 |y|) / 2: from -6 to 6 an area of 156.
    model("hexagonal_cell", (1, pin_in_prism, "18 pi 4^2"), (2, 2808 - pin_in_prism, "18 (156 - pi 4^2)"))


def balls():
    shells = [(n, ball(n) - ball(n - 1), f"4 pi/3 ({n}^3 - {n - 1}^3)") for n in range(1, 7)]
    model("sphere_shells", *shells)
    shells[3] = (4, ball(4) - ball(2), "4 pi/3 (4^3 - 2^3)")
    model("sphere_shells_overlap", *shells)
    model("graveyard", (1, ball(2), "4 pi/3 2^3"), (2, ball(3) - ball(2), "4 pi/3 (3^3 - 2^3)"),
          (3, None, "all that is outside"))
    model("unused", (1, ball(2), "4 pi/3 2^3"), (2, Number(0), "nowhere visible"))
    small = ball("0.2")
    model("touching_ball", (1, small, "4 pi/3 0.2^3"), (2, dec("2.8"), "0.7 * 2 * 2"),
          (3, dec("5.2") - small, "1.3 * 2 * 2 - 4 pi/3 0.2^3"))
    model("touching_balls", (1, ball(1), "4 pi/3"), (2, ball(1), "4 pi/3"),
          (3, ball(5) - 2 * ball(1), "4 pi/3 (5^3 - 2)"))
    d = dec("1.999995")
    lens = PI / 12 * (4 + d) * (2 - d) * (2 - d)
    model("overlapping_balls", (1, ball(1), "4 pi/3"), (2, ball(1), "4 pi/3"),
          (3, ball(5) - 2 * ball(1) + lens, "4 pi/3 (5^3 - 2) + pi/12 (4 + d) (2 - d)^2, d = 1.999995"))
    for name, radius, seen in (("hidden_gap", "1.9", "1.9"), ("visible_gap", "2.1", "2")):
        half = ball(seen) / 2
        model(name, (1, half, f"2 pi/3 {seen}^3"), (2, half, f"2 pi/3 {seen}^3"),
              (10, ball(radius), f"4 pi/3 {radius}^3"), (11, ball(20) - ball(radius), f"4 pi/3 (20^3 - {radius}^3)"))
    capsule, unit = 16 * PI / 3, ball(4)
    model("turned_units", (1, 3 * capsule, "3 (4 pi + 4 pi/3)"), (2, 3 * (unit - capsule), "3 (4 pi/3 4^3 - 16 pi/3)"),
          (10, unit, "4 pi/3 4^3"), (11, unit, "4 pi/3 4^3"), (12, unit, "4 pi/3 4^3"),
          (13, ball(20) - 3 * unit, "4 pi/3 (20^3 - 3 * 4^3)"), slack=ROUNDED_ROTATION)


def blocks():
    for name, pane in (("room_with_window", 10000), ("room_with_window_overlap", 10100)):
        model(name, (1, Number(500**3), "500^3"), (2, Number(560**3 - 500**3 - 300000), "560^3 - 500^3 - 30 * 100^2"),
              (3, Number(pane), f"{pane // 100} * 100"), (4, Number(290000), "29 * 100^2"))
    for name, radius in (("rounded_corner", "2"), ("rounded_corner_gap", "1.9999")):
        model(name, (1, 20 * (396 + disc(radius) / 4), f"20 (20^2 - 2^2 + pi/4 {radius}^2)"),
              (2, 20 * (180 - PI), "20 (24^2 - 20^2 + 2^2 - pi/4 2^2)"))
    model("coincident_surfaces", (1, Number(550), "5.5 * 10 * 10"), (2, Number(450), "4.5 * 10 * 10"))
    # A square of side a and itself turned by 45 degrees: 2 a^2 / (1 + sqrt 2).
    model("turned_box_gap", (1, Number(128) / (1 + square_root(2)),
                             "4 * 2 * 4^2 / (1 + sqrt 2)"), (10, Number(64), "4^3"), (11, Number(936), "10^3 - 4^3"),
          slack=ROUNDED_ROTATION)
    rods = 18 * disc("0.4096")
    all_elements = 18 * dec("1.5876")
    for name, plate in (("clipped_overlap", Number(0)), ("visible_overlap", 18 * dec("0.03") * dec("1.26"))):
        model(name, (1, rods, "9 * 2 pi 0.4096^2"), (2, all_elements - rods, "9 * 2 (1.26^2 - pi 0.4096^2)"),
              (3, plate, "9 * 2 * 1.26 times what is visible of the plate"), (10, all_elements, "2 * 3.78^2"))
    # Of a ball over the rectangle [0, a] x [0, b], the integral of sqrt(R^2 - x^2 - y^2), c = sqrt(R^2 - a^2 - b^2):
    # a b c / 3 + a (3 R^2 - a^2) / 6 arctan(b / c) + b (3 R^2 - b^2) / 6 arctan(a / c) - R^3 / 3 arctan(a b / (R c)).
    a, radius = dec("0.25"), dec("0.4")
    c = square_root(radius * radius - 2 * a * a)
    quarter = (a * a * c / 3 + a * (3 * radius * radius - a * a) / 3 * arc_tangent(a / c) -
               radius * radius * radius / 3 * arc_tangent(a * a / (radius * c)))
    inside = 32 * ball("0.4") + 32 * 8 * quarter
    text = "32 * 4 pi/3 0.4^3 + 32 * 8 I, I the integral of sqrt(0.4^2 - x^2 - y^2) to x, y = 1/4"
    for name, height in (("layered_lattice", "4"), ("layered_lattice_gap", "4.000002")):
        model(name, (1, inside, text), (2, 40 - inside, f"32 + 32/4 - ({text})"), (3, Number(24), "16 + 32/4"),
              (4, Number(16), "16"), (10, 16 * dec(height), f"4 * 4 * {height}"))


def round_bodies():
    inner, outer = 400 * 50 * PI + ball(20) / 2, 484 * 50 * PI + ball(22) / 2
    model("vessel", (1, inner, "50 pi 20^2 + 2 pi/3 20^3"), (2, outer - inner, "50 pi (22^2 - 20^2) + 2 pi/3 (22^3 - 20^3)"),
          (3, ball(100) - outer, "4 pi/3 100^3 - 50 pi 22^2 - 2 pi/3 22^3"))

    def pipes(r):
        """A cylinder within a ball of radius 30: 4 pi/3 (30^3 - (30^2 - r^2)^(3/2)); two share 16 r^3 / 3."""
        rest = Number(900 - r * r)
        return 2 * (Fraction(4, 3) * PI * (27000 - rest * square_root(rest))) - Number(Fraction(16 * r**3, 3))

    text = "U(r) = 8 pi/3 (30^3 - (30^2 - r^2)^(3/2)) - 16 r^3/3"
    model("tee", (1, pipes(3), f"U(3), {text}"), (2, pipes(4) - pipes(3), f"U(4) - U(3), {text}"),
          (3, ball(30) - pipes(4), f"4 pi/3 30^3 - U(4), {text}"))
    # pi times the integral of c + z^2/4 from -20 to 10: pi (30 c + 750)
    for name, waist in (("cooling_tower", "49"), ("cooling_tower_gap", "48.999999")):
        model(name, (1, 1830 * PI, "pi (30 * 36 + 750)"), (2, 30 * (dec(waist) - 36) * PI, f"30 pi ({waist} - 36)"),
              (3, 45780 * PI, "30 pi 40^2 - pi (30 * 49 + 750)"))
    # The lid x + 2 z = 20 cuts the cone in an ellipse whose shadow is 15/16 (x + 4/3)^2 + y^2 = 80/3;
    # a third of the shadow's area times 10, the height of the lid over the apex.
    funnel = 3200 * PI / (9 * square_root(15))
    model("funnel", (1, 2 * PI / 3, "4 pi/3 * 1 * 1 * 1/2"),
          (2, funnel - 2 * PI / 3, "3200 pi / (9 sqrt 15) - 2 pi/3"),
          (3, ball(30) - funnel, "4 pi/3 30^3 - 3200 pi / (9 sqrt 15)"))
    sharp = 144 * PI * (1 - Number(2) / square_root(5))
    model("cone_on_slope", (1, sharp, "2 pi/3 6^3 (1 - 2 / sqrt 5)"), (2, 144 * PI, "2 pi/3 6^3"),
          (3, 144 * PI - sharp, "2 pi/3 6^3 * 2 / sqrt 5"))
    model("second_nappe", (1, 152 * PI / 3, "pi/3 (3^3 + 5^3)"), (2, 72 * PI, "2 pi 6^2"),
          (3, 174 * PI, "6 pi 6^2 - pi/3 (1 + 5^3)"))
    angle = 2 * arc_tangent(Fraction(3, 4))
    narrow, broad = 500 * angle, 500 * (PI - angle)
    cells = [(1, narrow, "10 * 10^2 arctan(3/4)"), (2, broad, "10 * 10^2 (pi/2 - arctan(3/4))"),
             (3, narrow, "10 * 10^2 arctan(3/4)"), (4, broad, "10 * 10^2 (pi/2 - arctan(3/4))")]
    model("wedges", *cells)
    # The plane 5 x + y = -1e-6 meets the sides at x = -1e-6 / 4.25 and -1e-6 / 5.75.
    triangle = dec("0.75") * dec("1e-12") / (dec("4.25") * dec("5.75"))
    cells[2] = (3, narrow - 10 * triangle, "10 * 10^2 arctan(3/4) - 10 * 0.75e-12 / (4.25 * 5.75)")
    model("wedges_gap", *cells)


def tori():
    whole = 40 * PI * PI
    model("torus_on_plate", (1, whole, "2 pi^2 5 * 2^2"), (2, Number(4000), "20 * 20 * 10"),
          (3, 4000 - whole, "20 * 20 * 10 - 2 pi^2 5 * 2^2"))
    # The segment of depth h = 1e-6 of a disc of radius 2, which has its centre 5 from the axis.
    h = dec("1e-6")
    segment = 4 * arc_cosine(1 - h / 2) - (2 - h) * square_root(4 * h - h * h)
    model("torus_in_plate", (1, whole, "2 pi^2 5 * 2^2"), (2, Number(4000), "20 * 20 * 10"),
          (3, 4000 - whole + 10 * PI * segment,
           "20 * 20 * 10 - 2 pi^2 5 * 2^2 + 10 pi times a segment of depth 1e-6 of a disc of radius 2"))
    angle = arc_tangent(Fraction(3, 4))
    of_torus = 6 * PI * angle  # times the semi-axes
    for name, across in (("tokamak_sector", "2.3"), ("tokamak_sector_gap", "2.3001")):
        model(name, (1, 6 * of_torus, "6 pi t 3 * 2, t = arctan(3/4)"),
              (2, (dec("7.59") - 6) * of_torus, "6 pi t (3.3 * 2.3 - 3 * 2), t = arctan(3/4)"),
              (3, (12 - dec("3.3") * dec(across)) * of_torus, f"6 pi t (4 * 3 - 3.3 * {across}), t = arctan(3/4)"),
              (4, 8 * angle, "16 t/2, t = arctan(3/4)"),
              (5, 1144 * angle - 12 * of_torus, "16 t/2 (12^2 - 1) - 6 pi t 4 * 3, t = arctan(3/4)"))


def entry(volume, form, slack):
    return {"volume": None if volume is None else volume.bounds(slack), "form": form}


def materials_of(name):
    """The numbers of the cells with each material, void first, in the order of the model."""
    cells = {}
    for cell in ElementTree.parse(HERE / f"{name}.xml").iter("cell"):
        if cell.get("material") is not None:
            cells.setdefault(cell.get("material"), []).append(int(cell.get("id")))
    return dict(sorted(cells.items(), key=lambda item: (item[0] != "void", item[0].zfill(9))))


def golden(name):
    cells, slack = MODELS[name]
    volumes = {number: volume for number, volume, _ in cells}
    materials = {}
    for material, numbers in materials_of(name).items():
        parts = [volumes[number] for number in numbers]
        total = None if None in parts else sum(parts, Number(0))
        form = f"cell {numbers[0]}" if len(numbers) == 1 else f"the sum of {len(numbers)} cells"
        materials[material] = entry(total, form, slack)
    return {"cells": {str(number): entry(volume, form, slack) for number, volume, form in cells},
            "materials": materials}


def main():
    for write in (pin_cells, hexagons, balls, blocks, round_bodies, tori):
        write()
    document = {"schema": "exactcsg.geometry_golden/1", "models": {name: golden(name) for name in sorted(MODELS)}}
    text = json.dumps(document, indent=1) + "\n"
    file = HERE / "golden.json"
    if file.exists() and file.read_text() == text:
        return
    if sys.argv[1:] == ["--check"]:
        print("would change golden.json")
        sys.exit(1)
    file.write_text(text)


if __name__ == "__main__":
    main()
