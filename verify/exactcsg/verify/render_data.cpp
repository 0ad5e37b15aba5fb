// SPDX-License-Identifier: GPL-3.0-or-later
// JSON and JUnit XML, and writing a report to a file.
#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Check& check) {
  Json places = Json::array();
  for (const Mismatch& mismatch : check.mismatches) {
    places.push_back({{"text", mismatch.text}, {"where", mismatch.where}});
  }
  return {{"oracle", check.oracle},
          {"name", check.name},
          {"verdict", name_of(check.verdict)},
          {"ours", check.ours},
          {"theirs", check.theirs},
          {"difference", check.difference},
          {"bound", check.bound},
          {"explanation", check.explanation},
          {"mismatch_count", check.mismatch_count},
          {"mismatches", std::move(places)}};
}

std::string message_of(const Check& check) {
  std::string text = check.explanation;
  for (const Mismatch& mismatch : check.mismatches) {
    text += text.empty() ? "" : "\n";
    text += mismatch.text;
    for (const auto& p : mismatch.where) {
      text += fmt::format(" ({:.17g}, {:.17g}, {:.17g})", p[0], p[1], p[2]);
    }
  }
  return text;
}

}  // namespace

std::string render_json(const Report& report) {
  Json checks = Json::array();
  for (const Check& check : report.checks) checks.push_back(json_of(check));
  const Json document = {{"schema", "exactcsg.verify/1"},
                         {"model", report.model},
                         {"verdict", name_of(report.overall())},
                         {"digest", report.digest},
                         {"library", report.library},
                         {"seconds", report.seconds},
                         {"passed", report.count(Verdict::Passed)},
                         {"failed", report.count(Verdict::Failed)},
                         {"skipped", report.count(Verdict::Skipped)},
                         {"checks", std::move(checks)},
                         {"notes", report.notes}};
  // Text of files may not be UTF-8: what is not is replaced, never an exception.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string render_junit(const Report& report) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  auto suite = document.append_child("testsuites").append_child("testsuite");
  suite.append_attribute("name") = report.model.c_str();
  suite.append_attribute("tests") = static_cast<unsigned long long>(report.checks.size());
  suite.append_attribute("failures") =
      static_cast<unsigned long long>(report.count(Verdict::Failed));
  suite.append_attribute("skipped") =
      static_cast<unsigned long long>(report.count(Verdict::Skipped));
  suite.append_attribute("time") = fmt::format("{:.3f}", report.seconds).c_str();
  for (const Check& check : report.checks) {
    auto test = suite.append_child("testcase");
    test.append_attribute("classname") = check.oracle.c_str();
    test.append_attribute("name") = check.name.c_str();
    if (check.verdict == Verdict::Passed) continue;
    auto outcome = test.append_child(check.verdict == Verdict::Failed ? "failure" : "skipped");
    outcome.append_attribute("message") =
        fmt::format("ours {}, oracle {}, difference {}, bound {}", check.ours, check.theirs,
                    check.difference, check.bound)
            .c_str();
    outcome.text().set(message_of(check).c_str());
  }
  std::ostringstream out;
  document.save(out, "  ");
  return out.str();
}

void write_report(const Report& report, const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  std::string text;
  if (ending == ".json") {
    text = render_json(report);
  } else if (ending == ".xml") {
    text = render_junit(report);
  } else if (ending == ".html" || ending == ".htm") {
    text = render_html(report);
  } else if (ending == ".txt") {
    text = render_text(report);
  } else {
    throw Error(ErrorId::UnknownFormat, {file.string(), "a report in .json, .xml, .html or .txt"});
  }
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.flush();
  if (!out) throw Error(ErrorId::FileNotWritable, {file.string(), "a writable file"});
}

}  // namespace exactcsg::verify
