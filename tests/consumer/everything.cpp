// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a model from text, measures it, and asks the oracles' names: links all three libraries.
// A cube of 2 without one of its corner cubes of 1: volume 8 - 1 = 7.

#include <cstdio>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "exactcsg/verify/verify.hpp"

int main() {
  using namespace exactcsg;
  try {
    const io::Model model = io::read_openscad_csg(
        "difference() { cube(size = [2, 2, 2], center = false);"
        " cube(size = [1, 1, 1], center = false); }\n",
        "notched.csg");
    const Boundary boundary = evaluate(model.solid);
    const auto volume = exact_volume(boundary);
    std::printf("volume %s, %zu oracles\n", volume ? to_text(*volume).c_str() : "?",
                verify::oracle_names().size());
    verify::VerifyOptions options;
    options.disabled = {"nef", "openscad"};
    const auto report = verify::verify_boundary(model, boundary, options);
    return volume == Rational(7) && report.overall() != verify::Verdict::Failed ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
