// SPDX-License-Identifier: CC0-1.0
// A name plate: letters raised and engraved, in three fonts, centred, spaced out and seen from behind.

module label(words, size, font, spacing = 1, valign = "center")
  text(words, size = size, font = font, spacing = spacing, halign = "center", valign = valign, $fn = 8);

difference() {
  union() {
    linear_extrude(height = 3) offset(r = 4, $fn = 32) square([84, 34], center = true);
    // The baseline of the name is above the middle; the plate's face and the letters' feet coincide.
    translate([0, 3, 3]) linear_extrude(height = 2) label("exactcsg", 12, "Liberation Sans:style=Bold", 1.05, "baseline");
  }
  // Engraved below the name.
  translate([0, -9, 2]) linear_extrude(height = 5) label("AVON & \u00e9\u00df", 6, "Liberation Serif:style=Italic");
  // The back is engraved as well, mirrored.
  translate([0, 0, -1]) mirror([1, 0, 0]) linear_extrude(height = 2) label("0.1 = 1/10", 9, "Liberation Mono");
}
