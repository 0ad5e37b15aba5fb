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


def box(g, first, half, height, boundary="reflective"):
    for axis, reach in (("x", half), ("y", half), ("z", height)):
        for side in (-1, 1):
            g.surface(first, f"{axis}-plane", [side * reach], boundary)
            first += 1


BOX = "101 -102 103 -104 105 -106"


def pin_cell(about, with_gap=True):
    g = Geometry(about)
    g.surface(1, "z-cylinder", [0, 0, FUEL])
    g.surface(2, "z-cylinder", [0, 0, CLAD_INSIDE])
    g.surface(3, "z-cylinder", [0, 0, CLAD_OUTSIDE])
    box(g, 101, PITCH // 2, 10 * CM)
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


def sphere_shells():
    g = Geometry("Five concentric shells round a ball.")
    for number in range(1, 7):
        g.surface(number, "sphere", [0, 0, 0, number * CM], "vacuum" if number == 6 else None)
    g.cell(1, "-1", material=1)
    for number in range(2, 7):
        g.cell(number, f"{number - 1} -{number}", material=number)
    return g.text()


def room():
    g = Geometry("A room of 5 m within walls of 30 cm, with a pane of 1 cm in a window of 1 m.")
    for number, (axis, place) in enumerate(
            [(a, s * r) for r in (250, 280) for a in "xyz" for s in (-1, 1)], start=1):
        g.surface(number, f"{axis}-plane", [place * CM], "vacuum" if abs(place) == 280 else None)
    for number, (axis, place) in enumerate((("y", -50), ("y", 50), ("z", -50), ("z", 50)), start=21):
        g.surface(number, f"{axis}-plane", [place * CM])
    g.surface(31, "x-plane", [264_500_000])
    g.surface(32, "x-plane", [265_500_000])
    outer, inner, window = "7 -8 9 -10 11 -12", "1 -2 3 -4 5 -6", "2 -8 21 -22 23 -24"
    g.cell(1, inner, material=1)
    g.cell(2, f"{outer} ~({inner}) ~({window})", material=2)
    g.cell(3, f"{window} 31 -32", material=3)
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


MODELS = {
    "pin_cell": pin_cell("A fuel pin with gap and cladding in a square of water."),
    "pin_cell_missing_cell": pin_cell("The pin cell without the cell between fuel and cladding.", with_gap=False),
    "assembly_17x17": assembly("A 17 x 17 assembly as a lattice of pins and guide tubes."),
    "assembly_17x17_wrong_pitch": assembly("The same with a pitch of 1.25 in the box of 1.26.", pitch=1_250_000),
    "assembly_17x17_flat": flat_assembly("A 17 x 17 assembly without universes: every pin is a cell of its own."),
    "assembly_17x17_overlap": flat_assembly(
        "The same with one pin moved by 0.310001 so that it overlaps its neighbour by 1e-6.", shift=310_001),
    "hexagonal_core": hexagonal_core(),
    "sphere_shells": sphere_shells(),
    "room_with_window": room(),
    "turned_units": turned_units(),
    "funnel": funnel(),
    "rounded_corner": rounded_corner("A block with a rounded edge in a liner of the same shape.", 2 * CM),
    "rounded_corner_gap": rounded_corner("The same, the block's edge rounded on a radius smaller by 1e-4.",
                                         1_999_900),
    "coincident_surfaces": coincident(),
    "touching_ball": touching(),
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
