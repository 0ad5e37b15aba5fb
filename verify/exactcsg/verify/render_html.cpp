// SPDX-License-Identifier: GPL-3.0-or-later
// One self-contained page: the table of checks, and for every failed check three orthographic
// pictures of the model's edges with the places that did not match drawn over them.
#include <fmt/format.h>

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <limits>

#include "exactcsg/verify/report.hpp"

namespace exactcsg::verify {
namespace {

namespace mustache = kainjow::mustache;

constexpr const char* page = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>exactcsg verify {{model}}</title><style>
body{font:15px/1.45 system-ui,sans-serif;margin:2rem;max-width:75rem;color:#222}
table{border-collapse:collapse;width:100%}th,td{padding:.3rem .6rem;text-align:left;border-bottom:1px solid #ddd}
td.n{font-family:ui-monospace,monospace;font-size:13px;word-break:break-all}
.passed{color:#1a7f37}.failed{color:#c62828;font-weight:600}.skipped{color:#9a6700}
.digest{font-family:ui-monospace,monospace;font-size:12px;color:#666}
svg{border:1px solid #ddd;margin:.3rem;background:#fff}figure{display:inline-block;margin:0}figcaption{font-size:12px;color:#666;text-align:center}
li{font-family:ui-monospace,monospace;font-size:13px}
</style></head><body>
<h1>{{model}}: <span class="{{verdict}}">{{verdict}}</span></h1>
<p>{{passed}} passed, {{failed}} failed, {{skipped}} skipped, {{seconds}} s</p><p class="digest">{{digest}}</p>
<table><tr><th>verdict</th><th>check</th><th>ours</th><th>oracle</th><th>difference</th><th>bound</th></tr>
{{#checks}}<tr><td class="{{verdict}}">{{verdict}}</td><td>{{name}}</td><td class="n">{{ours}}</td><td class="n">{{theirs}}</td><td class="n">{{difference}}</td><td class="n">{{bound}}</td></tr>
{{/checks}}</table>
{{#details}}<h2 class="{{verdict}}">{{name}}</h2><p>{{explanation}}</p>
{{{pictures}}}<ul>{{#mismatches}}<li>{{text}}</li>{{/mismatches}}</ul>{{#more}}<p>and {{more}} more</p>{{/more}}
{{/details}}
{{#notes}}<p>note: {{text}}</p>{{/notes}}
</body></html>
)";

struct View {
  const char* name;
  int right;
  int up;
};
constexpr View views[] = {
    {"top (x right, y up)", 0, 1}, {"front (x right, z up)", 0, 2}, {"side (y right, z up)", 1, 2}};

struct Window {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double bottom = std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();

  void add(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    bottom = std::min(bottom, y);
    top = std::max(top, y);
  }
};

constexpr double picture_size = 320;
constexpr double margin = 12;

std::string picture(const Report& report, const Check& check, const View& view) {
  const auto r = static_cast<std::size_t>(view.right);
  const auto u = static_cast<std::size_t>(view.up);
  Window window;
  for (const auto& edge : report.edges) {
    for (const auto& p : edge) window.add(p[r], p[u]);
  }
  for (const Mismatch& mismatch : check.mismatches) {
    for (const auto& p : mismatch.where) window.add(p[r], p[u]);
  }
  const double extent = std::max({window.right - window.left, window.top - window.bottom, 1e-300});
  const double scale = (picture_size - 2 * margin) / extent;
  const auto x = [&](const std::array<double, 3>& p) {
    return margin + (p[r] - window.left) * scale;
  };
  const auto y = [&](const std::array<double, 3>& p) {
    return picture_size - margin - (p[u] - window.bottom) * scale;
  };
  std::string svg = fmt::format(
      "<figure><svg width=\"{0}\" height=\"{0}\" viewBox=\"0 0 {0} {0}\"><g stroke=\"#9aa5b1\" "
      "stroke-width=\"0.7\">",
      picture_size);
  for (const auto& edge : report.edges) {
    svg += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>",
                       x(edge[0]), y(edge[0]), x(edge[1]), y(edge[1]));
  }
  svg += "</g><g stroke=\"#c62828\" fill=\"#c62828\" stroke-width=\"2\">";
  for (const Mismatch& mismatch : check.mismatches) {
    if (mismatch.where.size() == 1) {
      svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3\"/>", x(mismatch.where[0]),
                         y(mismatch.where[0]));
    }
    for (std::size_t i = 0; i + 1 < mismatch.where.size(); ++i) {
      svg += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\"/>",
                         x(mismatch.where[i]), y(mismatch.where[i]), x(mismatch.where[i + 1]),
                         y(mismatch.where[i + 1]));
    }
  }
  return svg + fmt::format("</g></svg><figcaption>{}</figcaption></figure>", view.name);
}

std::string pictures(const Report& report, const Check& check) {
  const bool located = std::any_of(check.mismatches.begin(), check.mismatches.end(),
                                   [](const Mismatch& m) { return !m.where.empty(); });
  std::string text;
  if (!located) return text;
  for (const View& view : views) text += picture(report, check, view);
  return text;
}

std::string mismatch_line(const Mismatch& mismatch) {
  std::string text = mismatch.text;
  for (const auto& p : mismatch.where) {
    text += fmt::format(" ({:.17g}, {:.17g}, {:.17g})", p[0], p[1], p[2]);
  }
  return text;
}

mustache::data summary_of(const Check& check) {
  mustache::data row;
  row.set("verdict", std::string(name_of(check.verdict)));
  row.set("name", check.name);
  row.set("ours", check.ours);
  row.set("theirs", check.theirs);
  row.set("difference", check.difference);
  row.set("bound", check.bound);
  row.set("explanation", check.explanation);
  return row;
}

}  // namespace

std::string render_html(const Report& report) {
  mustache::data checks(mustache::data::type::list);
  mustache::data details(mustache::data::type::list);
  for (const Check& check : report.checks) {
    checks.push_back(summary_of(check));
    if (check.verdict == Verdict::Passed) continue;
    mustache::data detail = summary_of(check);
    detail.set("pictures", pictures(report, check));
    mustache::data lines(mustache::data::type::list);
    for (const Mismatch& mismatch : check.mismatches) {
      lines.push_back(mustache::data("text", mismatch_line(mismatch)));
    }
    detail.set("mismatches", lines);
    if (check.mismatch_count > check.mismatches.size()) {
      detail.set("more", std::to_string(check.mismatch_count - check.mismatches.size()));
    }
    details.push_back(detail);
  }
  mustache::data notes(mustache::data::type::list);
  for (const std::string& note : report.notes) notes.push_back(mustache::data("text", note));

  mustache::data root;
  root.set("model", report.model);
  root.set("verdict", std::string(name_of(report.overall())));
  root.set("digest", report.digest);
  root.set("seconds", fmt::format("{:.2f}", report.seconds));
  root.set("passed", std::to_string(report.count(Verdict::Passed)));
  root.set("failed", std::to_string(report.count(Verdict::Failed)));
  root.set("skipped", std::to_string(report.count(Verdict::Skipped)));
  root.set("checks", checks);
  root.set("details", details);
  root.set("notes", notes);
  mustache::mustache document{std::string(page)};
  return document.render(root);
}

}  // namespace exactcsg::verify
