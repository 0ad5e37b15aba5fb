// SPDX-License-Identifier: GPL-3.0-or-later
// The Nef oracle in a process of its own, and its result as text.
#include <fmt/format.h>

#include <charconv>
#include <csignal>
#include <sstream>

#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/nef.hpp"
#include "exactcsg/verify/process.hpp"

namespace exactcsg::verify {
namespace {

constexpr int base = 16;  // conversion in linear time
constexpr std::string_view class_letters = "OSI";

[[noreturn]] void broken(const std::string& line) {
  throw Error(ErrorId::OracleFailed, {"the Nef process wrote: " + line.substr(0, 80), ""});
}

void append(std::string& text, const Rational& value) {
  text += ' ';
  text += value.get_str(base);
}

Rational read_number(std::istringstream& in, const std::string& line) {
  std::string word;
  Rational value;
  if (!(in >> word) || value.set_str(word, base) != 0 || value.get_den() == 0) broken(line);
  value.canonicalize();
  return value;
}

void read_line(const std::string& line, NefResult& result) {
  std::istringstream in(line);
  char kind = 0;
  in >> kind;
  if (kind == 'v') {
    Point3 p;
    p.x = read_number(in, line);
    p.y = read_number(in, line);
    p.z = read_number(in, line);
    result.complex.vertices.push_back(std::move(p));
  } else if (kind == 'f') {
    const Rational a = read_number(in, line);
    const Rational b = read_number(in, line);
    const Rational c = read_number(in, line);
    const Rational d = read_number(in, line);
    result.complex.facets.push_back({make_plane(a, b, c, d), {}});
  } else if (kind == 'c') {
    if (result.complex.facets.empty()) broken(line);
    std::vector<std::uint32_t> cycle;
    for (std::uint32_t v = 0; in >> v;) {
      if (v >= result.complex.vertices.size()) broken(line);
      cycle.push_back(v);
    }
    result.complex.facets.back().cycles.push_back(std::move(cycle));
  } else if (kind == 'p') {
    for (char letter = 0; in >> letter;) {
      const auto found = class_letters.find(letter);
      if (found == std::string_view::npos) broken(line);
      result.classes.push_back(static_cast<PointClass>(found));
    }
  } else {
    broken(line);
  }
}

std::string reason_of(const ProcessResult& run, const NefLimits& limits) {
  if (run.end == ProcessEnd::OverTime)
    return fmt::format("over the budget of {:g} s", limits.seconds);
  if (run.end == ProcessEnd::Signalled) {
    return fmt::format("the Nef process was ended by signal {}{}", run.status,
                       run.status == SIGKILL || run.status == SIGABRT ? " (out of memory?)" : "");
  }
  const std::string text = run.messages.substr(0, 400);
  return text.empty() ? fmt::format("the Nef process ended with status {}", run.status) : text;
}

}  // namespace

std::string serialize(const NefResult& result) {
  std::string text;
  for (const Point3& p : result.complex.vertices) {
    text += 'v';
    append(text, p.x);
    append(text, p.y);
    append(text, p.z);
    text += '\n';
  }
  for (const OracleFacet& facet : result.complex.facets) {
    text += 'f';
    for (const Integer* c : {&facet.plane.a, &facet.plane.b, &facet.plane.c, &facet.plane.d}) {
      text += ' ' + c->get_str(base);
    }
    text += '\n';
    for (const auto& cycle : facet.cycles) {
      text += 'c';
      for (const std::uint32_t v : cycle) text += ' ' + std::to_string(v);
      text += '\n';
    }
  }
  text += "p ";
  for (const PointClass c : result.classes) text += class_letters[static_cast<std::size_t>(c)];
  return text + "\nend\n";
}

NefResult deserialize_nef(const std::string& text) {
  NefResult result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line == "end") return result;
    read_line(line, result);
  }
  broken("(nothing: it was cut short)");
}

NefOutcome run_nef(const Solid& solid, std::span<const Point3> points, const NefLimits& limits) {
  ProcessLimits process;
  process.seconds = limits.seconds;
  process.memory = limits.memory;
  process.progress = limits.progress;
  const ProcessResult run =
      run_forked([&] { return serialize(evaluate_nef(solid, points)); }, process);
  NefOutcome outcome;
  if (run.end != ProcessEnd::Exited || run.status != 0) {
    outcome.reason = reason_of(run, limits);
    return outcome;
  }
  outcome.result = deserialize_nef(run.output);
  outcome.answered = true;
  return outcome;
}

}  // namespace exactcsg::verify
