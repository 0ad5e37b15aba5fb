// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Sine and cosine of degrees exactly as OpenSCAD computes them, bit for bit. [Approximate]
//
// The argument is folded to [0, 90] before a library function is called, so that the vertices of a
// circle are symmetric about the axes, and 30, 45, 60 and 90 degrees give their best values.
// Source: OpenSCAD's src/degree_trig.cc (2021.01).
//
// LAW degree.1  sine(30) == 0.5, sine(90) == 1, cosine(60) == 0.5, cosine(90) == 0
// LAW degree.2  |result - true value| <= 2^-51 for 0 <= x <= 360: folding is exact (Sterbenz), the
// conversion to radians is off by at most 2.4 * 2^-53 of an angle below 0.79, and the library's
// value by one unit in the last place of a number below 1.

namespace exactcsg::io::openscad {

double sine_of_degrees(double x);    // NaN for |x| >= 360 * 2^52
double cosine_of_degrees(double x);  // NaN for |x| >= 360 * 2^52

}  // namespace exactcsg::io::openscad
