#!/usr/bin/env python3
# SPDX-License-Identifier: CC0-1.0
"""Writes the .xml files of this folder (--check: writes nothing, exit 1 if one would change).

All coefficients are whole millionths (of a centimetre) and computed as integers, so that a
file says what is meant and no binary rounding enters.
"""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent


def decimal(millionths):
    """1260000 -> '1.26'"""
    sign = "-" if millionths < 0 else ""
    whole, rest = divmod(abs(millionths), 1_000_000)
    digits = f"{rest:06d}".rstrip("0")
    return f"{sign}{whole}.{digits}" if digits else f"{sign}{whole}"


class Geometry:
    def __init__(self, about):
        self.lines = ["<?xml version='1.0' encoding='utf-8'?>", "<!-- SPDX-License-Identifier: CC0-1.0 -->",
                      f"<!-- {about} -->", "<geometry>"]

    def surface(self, number, kind, coefficients, boundary=None):
        text = " ".join(decimal(c) for c in coefficients)
        extra = f' boundary="{boundary}"' if boundary else ""
        self.lines.append(f'  <surface id="{number}" type="{kind}" coeffs="{text}"{extra}/>')

    def cell(self, number, region, material=None, fill=None, universe=None, more=""):
        what = f'fill="{fill}"' if fill is not None else f'material="{material}"'
        where = f' universe="{universe}"' if universe is not None else ""
        self.lines.append(f'  <cell id="{number}" {what}{where} region="{region}"{more}/>')

    def element(self, name, attributes, children):
        self.lines.append(f"  <{name} {attributes}>")
        for key, value in children:
            self.lines.append(f"    <{key}>{value}</{key}>")
        self.lines.append(f"  </{name}>")

    def text(self):
        return "\n".join(self.lines + ["</geometry>", ""])


FUEL, CLAD_INSIDE, CLAD_OUTSIDE = 409_600, 418_000, 475_000
TUBE_INSIDE, TUBE_OUTSIDE = 561_000, 602_000
PITCH = 1_260_000
CM = 1_000_000


def box(g, first, half, height, boundary="reflective", lid="reflective"):
    """The last plane, at the top, has no boundary condition if `lid` is None."""
    for axis, reach in (("x", half), ("y", half), ("z", height)):
        for side in (-1, 1):
            is_lid = axis == "z" and side == 1
            g.surface(first, f"{axis}-plane", [side * reach], None if is_lid and lid is None else boundary)
            first += 1


BOX = "101 -102 103 -104 105 -106"


def pin_cell(about, with_gap=True, lid="reflective"):
    g = Geometry(about)
    g.surface(1, "z-cylinder", [0, 0, FUEL])
    g.surface(2, "z-cylinder", [0, 0, CLAD_INSIDE])
    g.surface(3, "z-cylinder", [0, 0, CLAD_OUTSIDE])
    box(g, 101, PITCH // 2, 10 * CM, lid=lid)
    g.cell(1, "-1 105 -106", material=1)
    if with_gap:
        g.cell(2, "1 -2 105 -106", material="void")
    g.cell(3, "2 -3 105 -106", material=2)
    g.cell(4, f"3 {BOX}", material=3)
    return g.text()


# Rows and columns, from 0, of the guide tubes of a Westinghouse-like 17 x 17 assembly.
TUBES = {(2, 5), (2, 8), (2, 11), (3, 3), (3, 13), (5, 2), (5, 5), (5, 8), (5, 11), (5, 14), (8, 2), (8, 5),
         (8, 8), (8, 11), (8, 14), (11, 2), (11, 5), (11, 8), (11, 11), (11, 14), (13, 3), (13, 13), (14, 5),
         (14, 8), (14, 11)}


def assembly(about, pitch=PITCH):
    g = Geometry(about)
    for number, radius in ((1, FUEL), (2, CLAD_INSIDE), (3, CLAD_OUTSIDE), (4, TUBE_INSIDE), (5, TUBE_OUTSIDE)):
        g.surface(number, "z-cylinder", [0, 0, radius])
    box(g, 101, 17 * PITCH // 2, 183 * CM)
    g.cell(1, "-1", material=1, universe=1)
    g.cell(2, "1 -2", material="void", universe=1)
    g.cell(3, "2 -3", material=2, universe=1)
    g.cell(4, "3", material=3, universe=1)
    g.cell(5, "-4", material=3, universe=2)
    g.cell(6, "4 -5", material=2, universe=2)
    g.cell(7, "5", material=3, universe=2)
    g.cell(10, BOX, fill=50)
    rows = [" ".join("2" if (row, column) in TUBES else "1" for column in range(17)) for row in range(17)]
    corner = decimal(-17 * pitch // 2)
    g.element("lattice", 'id="50"', [("dimension", "17 17"), ("lower_left", f"{corner} {corner}"),
                                     ("pitch", f"{decimal(pitch)} {decimal(pitch)}"),
                                     ("universes", "\n" + "\n".join(rows) + "\n")])
    return g.text()


def flat_assembly(about, shift=0):
    """Every pin a cell of the root universe; the pin of row 8 and column 6 is moved along x."""
    g = Geometry(about)
    box(g, 1001, 17 * PITCH // 2, 183 * CM)
    inside = "1001 -1002 1003 -1004 1005 -1006"
    outside = []
    for row in range(17):
        for column in range(17):
            number = 17 * row + column + 1
            x = (column - 8) * PITCH + (shift if (row, column) == (8, 6) else 0)
            g.surface(number, "z-cylinder", [x, (8 - row) * PITCH, CLAD_OUTSIDE])
            g.cell(number, f"-{number} 1005 -1006", material=1)
            outside.append(str(number))
    g.cell(1000, f"{inside} {' '.join(outside)}", material=3)
    return g.text()


def hexagonal_core():
    g = Geometry("A core of 19 hexagonal assemblies of 37 pins each: two hexagonal lattices, one in the other.")
    g.surface(1, "z-cylinder", [0, 0, 400_000])
    g.surface(2, "z-cylinder", [0, 0, 25 * CM], "vacuum")
    g.surface(3, "z-plane", [-50 * CM], "vacuum")
    g.surface(4, "z-plane", [50 * CM], "vacuum")
    g.cell(1, "-1", material=1, universe=1)
    g.cell(2, "1", material=2, universe=1)
    g.cell(3, "", material=2, universe=2)
    g.cell(4, "", fill=60, universe=3)
    g.cell(5, "-2 3 -4", fill=70)
    pins = ["1 " * length for length in (4, 5, 6, 7, 6, 5, 4)]
    g.element("hex_lattice", 'id="60" n_rings="4" orientation="x" outer="2"',
              [("center", "0 0"), ("pitch", "1.2"), ("universes", "\n" + "\n".join(p.strip() for p in pins) + "\n")])
    rows = ["3 " * length for length in (1, 2, 3, 2, 3, 2, 3, 2, 1)]
    g.element("hex_lattice", 'id="70" n_rings="3" orientation="y" outer="2"',
              [("center", "0 0"), ("pitch", "8.5"), ("universes", "\n" + "\n".join(r.strip() for r in rows) + "\n")])
    return g.text()


def sphere_shells(about, slip=False):
    g = Geometry(about)
    for number in range(1, 7):
        g.surface(number, "sphere", [0, 0, 0, number * CM], "vacuum" if number == 6 else None)
    g.cell(1, "-1", material=1)
    for number in range(2, 7):
        inner = 2 if slip and number == 4 else number - 1
        g.cell(number, f"{inner} -{number}", material=number)
    return g.text()


def room(about, pane="21 -22 23 -24"):
    g = Geometry(about)
    for number, (axis, place) in enumerate(
            [(a, s * r) for r in (250, 280) for a in "xyz" for s in (-1, 1)], start=1):
        g.surface(number, f"{axis}-plane", [place * CM], "vacuum" if abs(place) == 280 else None)
    for number, (axis, place) in enumerate((("y", -50), ("y", 50), ("z", -50), ("z", 50)), start=21):
        g.surface(number, f"{axis}-plane", [place * CM])
    if "25" in pane:
        g.surface(25, "y-plane", [51 * CM])
    g.surface(31, "x-plane", [264_500_000])
    g.surface(32, "x-plane", [265_500_000])
    outer, inner, window = "7 -8 9 -10 11 -12", "1 -2 3 -4 5 -6", "2 -8 21 -22 23 -24"
    g.cell(1, inner, material=1)
    g.cell(2, f"{outer} ~({inner}) ~({window})", material=2)
    g.cell(3, f"2 -8 {pane} 31 -32", material=3)
    g.cell(4, f"{window} (-31 | 32)", material=1)
    return g.text()


def turned_units():
    g = Geometry("One unit, a capsule in air, put down three times: moved, turned by 90 and by 30 degrees.")
    g.surface(1, "x-cylinder", [0, 0, CM])
    g.surface(2, "x-plane", [-2 * CM])
    g.surface(3, "x-plane", [2 * CM])
    g.surface(4, "sphere", [-2 * CM, 0, 0, CM])
    g.surface(5, "sphere", [2 * CM, 0, 0, CM])
    capsule = "(-1 2 -3) | -4 | -5"
    g.cell(1, capsule, material=1, universe=1)
    g.cell(2, f"~({capsule})", material=2, universe=1)
    for number, x in ((10, -10), (11, 0), (12, 10)):
        g.surface(number, "sphere", [x * CM, 0, 0, 4 * CM])
    g.surface(13, "sphere", [0, 0, 0, 20 * CM], "vacuum")
    g.cell(10, "-10", fill=1, more=' translation="-10 0 0"')
    g.cell(11, "-11", fill=1, more=' rotation="0 0 90"')
    g.cell(12, "-12", fill=1, more=' translation="10 0 0" rotation="0 30 0"')
    g.cell(13, "10 11 12 -13", material=2)
    return g.text()


def funnel():
    g = Geometry("A funnel: a cone above its apex, an ellipsoid given as a quadric, and a slanted lid.")
    g.surface(1, "z-cone", [0, 0, 0, CM // 4])
    g.surface(2, "z-plane", [0])
    g.surface(3, "plane", [CM, 0, 2 * CM, 20 * CM])
    g.surface(4, "quadric", [CM, CM, 4 * CM, 0, 0, 0, 0, 0, -48 * CM, 143 * CM])  # x2+y2+4(z-6)2=1
    g.surface(5, "sphere", [0, 0, 0, 30 * CM], "vacuum")
    g.cell(1, "-4", material=1)
    g.cell(2, "-1 2 -3 4", material=2)
    g.cell(3, "-5 4 ~(-1 2 -3)", material=3)
    return g.text()


def rounded_corner(about, radius):
    """A block whose vertical edge at (10, 10) is rounded with radius 2, in a liner."""
    g = Geometry(about)
    box(g, 101, 12 * CM, 10 * CM, "vacuum")
    for number, (axis, place) in enumerate((("x", -10), ("x", 10), ("y", -10), ("y", 10), ("x", 8), ("y", 8)),
                                           start=1):
        g.surface(number, f"{axis}-plane", [place * CM])
    g.surface(7, "z-cylinder", [8 * CM, 8 * CM, 2 * CM])
    g.surface(8, "z-cylinder", [8 * CM, 8 * CM, radius])
    square = "1 -2 3 -4"
    block = f"{square} (-5 | -6 | -8)"
    g.cell(1, f"{block} 105 -106", material=1)
    g.cell(2, f"{BOX} ~({square} (-5 | -6 | -7))", material=2)
    return g.text()


def coincident():
    g = Geometry("Two slabs, each with its own id and equation for the plane between them.")
    box(g, 101, 5 * CM, 5 * CM)
    g.surface(1, "x-plane", [500_000])
    g.surface(2, "plane", [-2 * CM, 0, 0, -CM])
    g.cell(1, "101 -1 103 -104 105 -106", material=1)
    g.cell(2, "-2 -102 103 -104 105 -106", material=2)
    return g.text()


def touching():
    g = Geometry("A ball that touches a plate: 0.1 + 0.2 is 0.3 here; in doubles they overlap by 2.8e-17.")
    box(g, 101, CM, CM)
    g.surface(1, "sphere", [100_000, 0, 0, 200_000])
    g.surface(2, "x-plane", [300_000])
    g.cell(1, "-1", material=1)
    g.cell(2, "2 -102 103 -104 105 -106", material=2)
    g.cell(3, "1 101 -2 103 -104 105 -106", material=3)
    return g.text()


def two_dimensional_pin():
    g = Geometry("A fuel pin in a square of water, without ends.")
    g.surface(1, "z-cylinder", [0, 0, FUEL])
    for number, (axis, side) in enumerate((a, s) for a in "xy" for s in (-1, 1)):
        g.surface(101 + number, f"{axis}-plane", [side * PITCH // 2], "reflective")
    g.cell(1, "-1", material=1)
    g.cell(2, "1 101 -102 103 -104", material=2)
    return g.text()


def hexagonal_cell():
    """The slanted planes are at 7 from the axis: 4 x + 3 y = 35, so that all is rational."""
    g = Geometry("A pin in a hexagonal prism of slanted planes, reflective all round.")
    g.surface(1, "z-cylinder", [0, 0, 4 * CM])
    g.surface(2, "y-plane", [-6 * CM], "reflective")
    g.surface(3, "y-plane", [6 * CM], "reflective")
    number = 4
    for a, b in ((4, 3), (4, -3), (-4, 3), (-4, -3)):
        g.surface(number, "plane", [a * CM, b * CM, 0, 35 * CM], "reflective")
        number += 1
    g.surface(8, "z-plane", [-9 * CM], "vacuum")
    g.surface(9, "z-plane", [9 * CM], "vacuum")
    g.cell(1, "-1 8 -9", material=1)
    g.cell(2, "1 2 -3 -4 -5 -6 -7 8 -9", material=2)
    return g.text()


def graveyard():
    g = Geometry("A ball in a shell, with a cell for all that is outside, as other codes want it.")
    g.surface(1, "sphere", [0, 0, 0, 2 * CM])
    g.surface(2, "sphere", [0, 0, 0, 3 * CM], "vacuum")
    g.cell(1, "-1", material=1)
    g.cell(2, "1 -2", material=2)
    g.cell(3, "2", material="void")
    return g.text()


def vessel():
    g = Geometry("A vessel: a cylinder with a hemisphere below it and a lid, tangent along a circle.")
    g.surface(1, "z-cylinder", [0, 0, 20 * CM])
    g.surface(2, "z-cylinder", [0, 0, 22 * CM])
    g.surface(3, "sphere", [0, 0, 0, 20 * CM])
    g.surface(4, "sphere", [0, 0, 0, 22 * CM])
    g.surface(5, "z-plane", [0])
    g.surface(6, "z-plane", [50 * CM])
    g.surface(7, "sphere", [0, 0, 0, 100 * CM], "vacuum")
    g.cell(1, "(-1 5 -6) | (-3 -5)", material=1)
    g.cell(2, "(1 -2 5 -6) | (3 -4 -5)", material=2)
    g.cell(3, "-7 ~((-2 5 -6) | (-4 -5))", material=3)
    return g.text()


def tee():
    g = Geometry("Two pipes of equal radius that meet at a right angle, in a ball.")
    for number, axis in ((1, "x"), (3, "z")):
        g.surface(number, f"{axis}-cylinder", [0, 0, 3 * CM])
        g.surface(number + 1, f"{axis}-cylinder", [0, 0, 4 * CM])
    g.surface(5, "sphere", [0, 0, 0, 30 * CM], "vacuum")
    g.cell(1, "-5 (-1 | -3)", material=1)
    g.cell(2, "-5 (-2 | -4) 1 3", material=2)
    g.cell(3, "-5 2 4", material=3)
    return g.text()


def cooling_tower(about, waist):
    """Hyperboloids of one sheet x2 + y2 - z2/4 = c, as quadrics."""
    g = Geometry(about)
    for number, squared in ((1, 36), (2, 49)):
        g.surface(number, "quadric", [CM, CM, -CM // 4, 0, 0, 0, 0, 0, 0, -squared * CM])
    g.surface(3, "quadric", [CM, CM, -CM // 4, 0, 0, 0, 0, 0, 0, -waist])
    g.surface(4, "z-plane", [-20 * CM], "vacuum")
    g.surface(5, "z-plane", [10 * CM], "vacuum")
    g.surface(6, "z-cylinder", [0, 0, 40 * CM], "vacuum")
    g.cell(1, "-1 4 -5", material=1)
    g.cell(2, "1 -3 4 -5", material=2)
    g.cell(3, "2 4 -5 -6", material=1)
    return g.text()


def wedges(about, offset=0):
    g = Geometry(about)
    g.surface(1, "plane", [3 * CM, 4 * CM, 0, 0])
    g.surface(2, "plane", [3 * CM, -4 * CM, 0, 0])
    g.surface(3, "plane", [5 * CM, CM, 0, offset])
    g.surface(4, "z-cylinder", [0, 0, 10 * CM], "vacuum")
    g.surface(5, "z-plane", [-5 * CM], "vacuum")
    g.surface(6, "z-plane", [5 * CM], "vacuum")
    ends = "-4 5 -6"
    # From the plane 3 x + 4 y = 0 to the right, counter-clockwise.
    g.cell(1, f"1 2 {ends}", material=1)
    g.cell(2, f"1 -2 {ends}", material=2)
    g.cell(3, f"-1 -2 -3 {ends}", material=3)
    g.cell(4, f"-1 2 {ends}", material=4)
    return g.text()


def layered_lattice(about, height):
    g = Geometry(about)
    g.surface(1, "sphere", [0, 0, 0, 400_000])
    box(g, 101, 2 * CM, height, "vacuum")
    g.cell(1, "-1", material=1, universe=1)
    g.cell(2, "1", material=2, universe=1)
    g.cell(3, "", material=2, universe=2)
    g.cell(4, "", fill=61, universe=3)
    g.cell(10, BOX, fill=60)
    layer = "\n3 1 1 3\n1 2 2 1\n1 2 2 1\n3 1 1 3\n"
    g.element("lattice", 'id="60"', [("dimension", "4 4 4"), ("lower_left", "-2 -2 -2"), ("pitch", "1 1 1"),
                                     ("universes", layer * 4)])
    g.element("lattice", 'id="61"', [("dimension", "2 2"), ("lower_left", "-0.5 -0.5"), ("pitch", "0.5 0.5"),
                                     ("universes", "\n1 2\n2 1\n")])
    return g.text()


def hexagonal_without_outer():
    g = Geometry("A hexagonal lattice of two rings without an outer universe, in a box that is larger.")
    g.surface(1, "z-cylinder", [0, 0, 400_000])
    box(g, 101, 2 * CM, CM)
    g.cell(1, "-1", material=1, universe=1)
    g.cell(2, "1", material=2, universe=1)
    g.cell(10, BOX, fill=60)
    g.element("hex_lattice", 'id="60" n_rings="2"', [("center", "0 0"), ("pitch", "1"),
                                                     ("universes", "\n1\n1 1\n1\n1 1\n1\n")])
    return g.text()


def clipped_lattice(about, place):
    """Every element has a rod at the centre, and a plate from x = `place` on that overlaps a tube there."""
    g = Geometry(about)
    g.surface(1, "z-cylinder", [0, 0, FUEL])
    g.surface(2, "x-plane", [place])
    g.surface(3, "x-plane", [place + 100_000])
    box(g, 101, 3 * PITCH // 2, CM)
    g.cell(1, "-1", material=1, universe=1)
    g.cell(2, "1 -3", material=2, universe=1)
    g.cell(3, "1 2", material=3, universe=1)
    g.cell(10, BOX, fill=60)
    corner = decimal(-3 * PITCH // 2)
    g.element("lattice", 'id="60"', [("dimension", "3 3"), ("lower_left", f"{corner} {corner}"),
                                     ("pitch", f"{decimal(PITCH)} {decimal(PITCH)}"),
                                     ("universes", "\n1 1 1\n1 1 1\n1 1 1\n")])
    return g.text()


def filled_ball(about, radius):
    """A universe that ends at the radius 2, seen through a ball of another radius at (5, 0, 0)."""
    g = Geometry(about)
    g.surface(1, "x-plane", [0])
    g.surface(2, "sphere", [0, 0, 0, 2 * CM])
    g.surface(3, "sphere", [5 * CM, 0, 0, radius])
    g.surface(4, "sphere", [0, 0, 0, 20 * CM], "vacuum")
    g.cell(1, "-2 -1", material=1, universe=1)
    g.cell(2, "-2 1", material=2, universe=1)
    g.cell(10, "-3", fill=1, more=' translation="5 0 0"')
    g.cell(11, "3 -4", material=3)
    return g.text()


def turned_box():
    g = Geometry("A cube that is turned by 45 degrees in a cell of the same size: its corners stay empty.")
    box(g, 1, 2 * CM, 2 * CM, None, None)
    box(g, 101, 5 * CM, 5 * CM)
    cube = "1 -2 3 -4 5 -6"
    g.cell(1, cube, material=1, universe=1)
    g.cell(10, cube, fill=1, more=' rotation="0 0 45"')
    g.cell(11, f"{BOX} ~({cube})", material=2)
    return g.text()


def balls(about, distance):
    g = Geometry(about)
    g.surface(1, "sphere", [0, 0, 0, CM])
    g.surface(2, "sphere", [3 * distance // 5, 4 * distance // 5, 0, CM])
    g.surface(3, "sphere", [0, 0, 0, 5 * CM], "vacuum")
    g.cell(1, "-1", material=1)
    g.cell(2, "-2", material=2)
    g.cell(3, "1 2 -3", material=3)
    return g.text()


def cone_on_slope():
    g = Geometry("A cone that stands with its apex on a slanted plane.")
    g.surface(1, "z-cone", [CM, CM, 2 * CM, CM // 4])
    g.surface(2, "z-plane", [2 * CM])
    g.surface(3, "plane", [CM, 0, 2 * CM, 5 * CM])
    g.surface(4, "sphere", [CM, CM, 2 * CM, 6 * CM], "vacuum")
    g.cell(1, "-1 2 -4", material=1)
    g.cell(2, "-3 -4", material=2)
    g.cell(3, "3 -4 ~(-1 2)", material=3)
    return g.text()


def second_nappe():
    g = Geometry("A funnel of which the second nappe was forgotten: it reaches into the floor.")
    g.surface(1, "z-cone", [0, 0, 0, CM])
    g.surface(2, "z-plane", [-CM])
    g.surface(3, "z-cylinder", [0, 0, 6 * CM], "vacuum")
    g.surface(4, "z-plane", [-3 * CM], "vacuum")
    g.surface(5, "z-plane", [5 * CM], "vacuum")
    g.cell(1, "-1 -5 4", material=1)
    g.cell(2, "-3 4 -2", material=2)
    g.cell(3, "1 -3 2 -5", material=3)
    return g.text()


def unused():
    g = Geometry("A ball, and beside it a surface, a universe and a lattice that nothing uses.")
    g.surface(1, "sphere", [0, 0, 0, 2 * CM], "vacuum")
    g.surface(2, "z-plane", [CM])
    g.surface(3, "x-plane", [CM])
    g.cell(1, "-1", material=1)
    g.cell(2, "-3", material=2, universe=7)
    g.element("lattice", 'id="60"', [("dimension", "1 1"), ("lower_left", "0 0"), ("pitch", "1 1"),
                                     ("universes", "7")])
    return g.text()


def torus_on_plate(about, height):
    g = Geometry(about)
    box(g, 101, 10 * CM, 10 * CM, "vacuum", "vacuum")
    g.surface(1, "z-torus", [0, 0, height, 5 * CM, 2 * CM, 2 * CM])
    g.surface(2, "z-plane", [0])
    g.cell(1, "-1", material=1)
    g.cell(2, "101 -102 103 -104 105 -2", material=2)
    g.cell(3, "1 101 -102 103 -104 2 -106", material=3)
    return g.text()


def tokamak_sector(about, slip=0):
    """A sector of atan(3/4) between reflective planes; elliptic tori round the axis."""
    g = Geometry(about)
    for number, (along, across) in enumerate(((3_000_000, 2_000_000), (3_300_000, 2_300_000), (4_000_000, 3_000_000)),
                                             start=1):
        g.surface(number, "z-torus", [0, 0, 0, 6 * CM, along, across])
    if slip:
        g.surface(22, "z-torus", [0, 0, 0, 6 * CM, 3_300_000, 2_300_000 + slip])
    g.surface(4, "z-cylinder", [0, 0, CM])
    g.surface(5, "z-cylinder", [0, 0, 12 * CM], "vacuum")
    g.surface(6, "z-plane", [-8 * CM], "vacuum")
    g.surface(7, "z-plane", [8 * CM], "vacuum")
    g.surface(10, "y-plane", [0], "reflective")
    g.surface(11, "plane", [3 * CM, -4 * CM, 0, 0], "reflective")
    g.cell(1, "-1 10 11", material=1)
    g.cell(2, "1 -2 10 11", material=2)
    g.cell(3, f"{'22' if slip else '2'} -3 10 11", material=3)
    g.cell(4, "-4 6 -7 10 11", material=4)
    g.cell(5, "3 4 -5 6 -7 10 11", material="void")
    return g.text()


MODELS = {
    "pin_cell": pin_cell("A fuel pin with gap and cladding in a square of water."),
    "pin_cell_missing_cell": pin_cell("The pin cell without the cell between fuel and cladding.", with_gap=False),
    "assembly_17x17": assembly("A 17 x 17 assembly as a lattice of pins and guide tubes."),
    "assembly_17x17_wrong_pitch": assembly("The same with a pitch of 1.25 in the box of 1.26.", pitch=1_250_000),
    "assembly_17x17_flat": flat_assembly("A 17 x 17 assembly without universes: every pin is a cell of its own."),
    "assembly_17x17_overlap": flat_assembly(
        "The same with one pin moved by 0.310001 so that it overlaps its neighbour by 1e-6.", shift=310_001),
    "hexagonal_core": hexagonal_core(),
    "sphere_shells": sphere_shells("Five concentric shells round a ball."),
    "sphere_shells_overlap": sphere_shells("The same, the fourth begun one surface too early.", slip=True),
    "room_with_window": room("A room of 5 m within walls of 30 cm, with a pane of 1 cm in a window of 1 m."),
    "room_with_window_overlap": room("The same, the pane 1 cm wider than the window.", "21 -25 23 -24"),
    "turned_units": turned_units(),
    "funnel": funnel(),
    "rounded_corner": rounded_corner("A block with a rounded edge in a liner of the same shape.", 2 * CM),
    "rounded_corner_gap": rounded_corner("The same, the block's edge rounded on a radius smaller by 1e-4.",
                                         1_999_900),
    "coincident_surfaces": coincident(),
    "touching_ball": touching(),
    "pin_cell_leak": pin_cell("The pin cell without a boundary condition at the top.", lid=None),
    "two_dimensional_pin": two_dimensional_pin(),
    "hexagonal_cell": hexagonal_cell(),
    "hexagonal_without_outer": hexagonal_without_outer(),
    "graveyard": graveyard(),
    "vessel": vessel(),
    "tee": tee(),
    "cooling_tower": cooling_tower("A shell between two hyperboloids of one sheet.", 49 * CM),
    "cooling_tower_gap": cooling_tower("The same, the shell thinner by 1e-6 of its square.", 49 * CM - 1),
    "wedges": wedges("Four wedges about one line, one of them with a plane through it that says nothing new."),
    "wedges_gap": wedges("The same, that plane moved by 1e-6 / sqrt(26).", -1),
    "layered_lattice": layered_lattice("A lattice of 4 x 4 x 4, other lattices in its corners.", 2 * CM),
    "layered_lattice_gap": layered_lattice("The same in a box that is higher by 1e-6.", 2 * CM + 1),
    "clipped_overlap": clipped_lattice("An overlap that the lattice's elements clip away.", 650_000),
    "visible_overlap": clipped_lattice("The same overlap, 0.03 of which the elements show.", 600_000),
    "hidden_gap": filled_ball("A universe that ends beyond the ball through which it is seen.", 1_900_000),
    "visible_gap": filled_ball("A universe that ends before the ball through which it is seen.", 2_100_000),
    "turned_box_gap": turned_box(),
    "touching_balls": balls("Two balls that touch where no coordinate is a round binary number.", 2 * CM),
    "overlapping_balls": balls("The same, nearer by 5e-6: a lens.", 2 * CM - 5),
    "cone_on_slope": cone_on_slope(),
    "second_nappe": second_nappe(),
    "unused": unused(),
    "torus_on_plate": torus_on_plate("A torus that touches the plate below it along a circle.", 2 * CM),
    "torus_in_plate": torus_on_plate("The same, lower by 1e-6.", 2 * CM - 1),
    "tokamak_sector": tokamak_sector("A sector of a tokamak: plasma, wall and blanket, and a column."),
    "tokamak_sector_gap": tokamak_sector("The same, the blanket begun 1e-4 too far out.", 100),
}


def main():
    check = sys.argv[1:] == ["--check"]
    changed = False
    for name, text in MODELS.items():
        file = HERE / f"{name}.xml"
        if file.exists() and file.read_text() == text:
            continue
        changed = True
        print(("would change " if check else "wrote ") + file.name)
        if not check:
            file.write_text(text)
    sys.exit(1 if check and changed else 0)


if __name__ == "__main__":
    main()
