// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "exactcsg/support/error.hpp"
#include "exactcsg/verify/golden.hpp"
#include "exactcsg/verify/process.hpp"
#include "exactcsg/verify/verify.hpp"
#include "samples.hpp"

namespace exactcsg::verify {
namespace {

Report sample_report() {
  Report report;
  report.model = "a<b>&\"c\"";
  report.digest = std::string(64, 'd');
  Check passed;
  passed.oracle = "nef";
  passed.name = "nef: volume";
  passed.ours = passed.theirs = "7";
  report.checks.push_back(passed);
  Check failed;
  failed.oracle = "against";
  failed.name = "x.stl: edges";
  add_mismatch(failed, {"edge <only> in ours", {{0, 0, 0}, {1, 0, 0}}});
  report.checks.push_back(failed);
  Check skipped;
  skipped.oracle = "openscad";
  skipped.name = "openscad";
  skipped.verdict = Verdict::Skipped;
  skipped.explanation = "not installed";
  report.checks.push_back(skipped);
  report.edges = {{{{0, 0, 0}, {0, 1, 0}}}};
  return report;
}

TEST(Report, OverallVerdict) {
  Report report = sample_report();
  EXPECT_EQ(report.overall(), Verdict::Failed);
  report.checks.erase(report.checks.begin() + 1);
  EXPECT_EQ(report.overall(), Verdict::Passed);
  report.checks.erase(report.checks.begin());
  EXPECT_EQ(report.overall(), Verdict::Skipped);  // nothing was confirmed
}

TEST(Report, RequiredOraclesMayNotBeSkipped) {  // LAW report.1
  Report report = sample_report();
  report.checks.erase(report.checks.begin() + 1);
  const std::vector<std::string> required{"openscad", "golden"};
  require_oracles(report, required);
  EXPECT_EQ(report.overall(), Verdict::Failed);
  EXPECT_EQ(report.count(Verdict::Failed), 2U);
}

TEST(Report, MismatchesAreCountedBeyondTheList) {
  Check check;
  for (std::size_t i = 0; i < 2 * listed_mismatches; ++i) add_mismatch(check, {"here", {}});
  EXPECT_EQ(check.mismatches.size(), listed_mismatches);
  EXPECT_EQ(check.mismatch_count, 2 * listed_mismatches);
  EXPECT_EQ(check.verdict, Verdict::Failed);
}

TEST(Report, TextNamesVerdictsAndPlaces) {
  const std::string text = render_text(sample_report());
  EXPECT_NE(text.find("failed   x.stl: edges"), std::string::npos) << text;
  EXPECT_NE(text.find("edge <only> in ours  at (0, 0, 0) - (1, 0, 0)"), std::string::npos) << text;
  EXPECT_NE(text.find("not installed"), std::string::npos);
  EXPECT_NE(text.find("1 passed, 1 failed, 1 skipped"), std::string::npos);
  EXPECT_EQ(text.find('\033'), std::string::npos);
  EXPECT_NE(render_text(sample_report(), {true, 100}).find("\033[31mfailed"), std::string::npos);
}

TEST(Report, JsonHasTheSchema) {
  const auto json = nlohmann::json::parse(render_json(sample_report()));
  EXPECT_EQ(json["schema"], "exactcsg.verify/1");
  EXPECT_EQ(json["verdict"], "failed");
  EXPECT_EQ(json["checks"][1]["mismatches"][0]["where"][1][0], 1.0);
}

TEST(Report, JunitIsXml) {
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(render_junit(sample_report()).c_str()));
  const auto suite = document.child("testsuites").child("testsuite");
  EXPECT_EQ(suite.attribute("tests").as_int(), 3);
  EXPECT_EQ(suite.attribute("failures").as_int(), 1);
  EXPECT_EQ(suite.attribute("skipped").as_int(), 1);
  EXPECT_STREQ(suite.attribute("name").value(), "a<b>&\"c\"");
}

TEST(Report, HtmlEscapesAndDraws) {
  const std::string html = render_html(sample_report());
  EXPECT_EQ(html.find("a<b>"), std::string::npos);
  EXPECT_NE(html.find("a&lt;b&gt;"), std::string::npos);
  EXPECT_NE(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("<line"), std::string::npos);
}

TEST(Report, WrittenByEnding) {
  const TemporaryFolder folder;
  for (const char* name : {"r.json", "r.xml", "r.html", "r.txt"}) {
    write_report(sample_report(), folder.path() / name);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / name));
  }
  EXPECT_THROW(write_report(sample_report(), folder.path() / "r.pdf"), Error);
  EXPECT_THROW(write_report(sample_report(), folder.path() / "no" / "r.json"), Error);
}

// ---- golden files
// ---------------------------------------------------------------------------------------

TEST(Golden, EntryOfThePlate) {
  const GoldenEntry entry = golden_entry(samples::plate_boundary(), "closed form");
  // 4*3*2 - 1*1*2 (hole) - 1*1*1 (notch) + the pyramid above z = 2: its base there is half as wide
  // as at z = 1, (2/7)^2 * 1 / 3.
  EXPECT_EQ(entry.volume_exact, to_text(Rational(21) + Rational(4, 147)));
  EXPECT_EQ(entry.components, 1U);
  EXPECT_EQ(entry.genus, 1);  // one through hole
}

TEST(Golden, RoundTrip) {
  const TemporaryFolder folder;
  GoldenFile golden;
  golden.models["plate"] = golden_entry(samples::plate_boundary(), "closed form");
  write_golden(golden, folder.path() / "g.json");
  EXPECT_EQ(read_golden(folder.path() / "g.json").models, golden.models);
}

TEST(Golden, BrokenFilesAreNamed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "g.json";
  const auto found = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      read_golden(file);
      return std::string("accepted");
    } catch (const Error& error) {
      EXPECT_EQ(error.id(), ErrorId::GoldenFile);
      return error.details().found;
    }
  };
  EXPECT_NE(found("{").find("parse error"), std::string::npos);
  EXPECT_NE(found("{}").find("schema"), std::string::npos);
  EXPECT_NE(found(R"({"schema":"exactcsg.golden/1"})").find("models"), std::string::npos);
  EXPECT_NE(
      found(R"({"schema":"exactcsg.golden/1","models":{"a":{"digest":"x"}}})").find("'volume'"),
      std::string::npos);
  EXPECT_NE(found(R"({"schema":"exactcsg.golden/1","models":{"a":{"digest":7}}})").find("'digest'"),
            std::string::npos);
  EXPECT_THROW(read_golden(folder.path() / "none.json"), Error);
}

// ---- the whole
// ------------------------------------------------------------------------------------------

TEST(Verify, PlateIsConfirmed) {
  VerifyOptions options;
  options.disabled = {"openscad"};
  options.required = {"nef", "sampling"};
  options.sample_points = 80;
  const Report report = verify_model(samples::model_of(samples::plate()), options);
  EXPECT_EQ(report.overall(), Verdict::Passed) << render_text(report);
  EXPECT_EQ(report.digest.size(), 64U);
}

TEST(Verify, SkippedOracleIsSaidAndRequiredOneFails) {  // LAW verify.2
  VerifyOptions options;
  options.disabled = {"nef", "laws", "sampling"};
  const auto model = samples::model_of(samples::plate());
  const Report skipped = verify_boundary(model, samples::plate_boundary(), options);
  ASSERT_NE(samples::find(skipped.checks, "openscad"), nullptr);
  EXPECT_EQ(samples::find(skipped.checks, "openscad")->verdict, Verdict::Skipped);
  options.required = {"openscad"};
  EXPECT_EQ(verify_boundary(model, samples::plate_boundary(), options).overall(), Verdict::Failed);
}

TEST(Verify, UnknownOracleIsRefused) {
  VerifyOptions options;
  options.required = {"nev"};
  EXPECT_THROW(verify_model(samples::model_of(samples::plate()), options), Error);
}

TEST(Verify, EmptyModel) {
  VerifyOptions options;
  options.disabled = {"openscad"};
  const Report report = verify_model(samples::model_of(Solid::empty(), "nothing"), options);
  EXPECT_EQ(report.count(Verdict::Failed), 0U) << render_text(report);
}

TEST(Verify, CancellationEndsTheRun) {
  Progress progress;
  progress.cancel();
  VerifyOptions options;
  options.progress = &progress;
  EXPECT_THROW(
      verify_boundary(samples::model_of(samples::plate()), samples::plate_boundary(), options),
      Error);
}

}  // namespace
}  // namespace exactcsg::verify
