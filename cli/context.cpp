// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <utility>

#include "cli/allocator.hpp"
#include "cli/command.hpp"

namespace exactcsg::cli {

EvaluateOptions Context::evaluate_options() {
  EvaluateOptions options;
  options.threads = common_.threads;
  options.progress = &progress_;
  return options;
}

void Context::warn(std::string text) {
  if (common_.quiet) return;
  const std::scoped_lock lock(mutex_);
  warnings_.push_back(std::move(text));
}

void Context::refuse(const Error& error) {
  const std::scoped_lock lock(mutex_);
  warnings_.emplace_back(error.what());
  if (!first_refusal_) first_refusal_ = error.id();
}

std::vector<std::string> Context::take_warnings() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(warnings_, {});
}

namespace {

// Below, huge pages are not worth their clearing.
constexpr std::size_t few_facets = 1000;

std::size_t facets_of(const Solid& solid) {
  std::size_t facets = 0;
  csg::for_each_primitive(solid, [&](const Primitive& primitive) {
    if (const StoredPolyhedron* polyhedron = polyhedron_of(primitive)) {
      facets += polyhedron->facets.size();
    }
  });
  return facets;
}

}  // namespace

void pass_on(Context& context, const std::vector<io::Warning>& warnings) {
  for (const io::Warning& warning : warnings) {
    const SourcePosition& at = warning.position;
    context.warn(at.line == 0 ? fmt::format("{}: warning: {}", at.file, warning.text)
                              : fmt::format("{}:{}:{}: warning: {}", at.file, at.line, at.column,
                                            warning.text));
  }
}

io::Model read(Context& context, const std::filesystem::path& file) {
  io::ReadOptions options;
  options.progress = &context.progress();
  options.fill = context.common().fill;
  options.threads = context.common().threads;
  context.progress().begin("read", 0);
  io::Model model = io::read_model(file, options);
  if (facets_of(model.solid) > few_facets) use_huge_pages();
  if (!model.front_end_messages.empty()) context.warn("openscad: " + model.front_end_messages);
  pass_on(context, model.warnings);
  return model;
}

}  // namespace exactcsg::cli
