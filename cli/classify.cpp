// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include "cli/command.hpp"
#include "cli/openmc.hpp"
#include "exactcsg/solid/classify.hpp"

namespace exactcsg::cli {

namespace {

struct Arguments {
  std::string model;
  std::string points;
};

// Below so many points a retained decomposition costs more than it saves.
constexpr std::size_t few_points = 8;

std::string read_points_text(const std::string& file) {
  std::ostringstream text;
  if (file == "-") {
    text << std::cin.rdbuf();
    return text.str();
  }
  const SourcePosition position{file};
  if (std::filesystem::is_directory(file)) {
    throw Error(ErrorId::FileNotReadable, {"a folder", "a file of points", position});
  }
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(ErrorId::FileNotReadable, {"", "a file of points", position});
  text << stream.rdbuf();
  return text.str();
}

// "x y z", decimals or fractions. Blank lines and lines that begin with # hold no point.
// THROWS Error(UnexpectedText | NumberOutOfRange) with line and column
class PointLine {
 public:
  PointLine(std::string_view line, SourcePosition position)
      : line_(line), position_(std::move(position)) {}

  bool holds_point() {
    skip_blanks();
    return at_ < line_.size() && line_[at_] != '#';
  }
  Point3 point() {
    Point3 result{number(), number(), number()};  // braces: evaluated from left to right
    skip_blanks();
    if (at_ < line_.size()) throw unexpected("more text", "the end of the line");
    return result;
  }

 private:
  void skip_blanks() {
    while (at_ < line_.size() && (line_[at_] == ' ' || line_[at_] == '\t')) ++at_;
  }
  SourcePosition position(std::size_t at) const {
    SourcePosition result = position_;
    result.column = at + 1;
    return result;
  }
  Error unexpected(std::string found, std::string expected) const {
    return Error(ErrorId::UnexpectedText, {std::move(found), std::move(expected), position(at_)});
  }
  Rational number() {
    skip_blanks();
    const std::size_t end = std::min(line_.find_first_of(" \t", at_), line_.size());
    const std::string_view word = line_.substr(at_, end - at_);
    if (word.empty()) throw unexpected("the end of the line", "three numbers, \"x y z\"");
    std::optional<Rational> value;
    try {
      value = parse_rational(word);
    } catch (const Error& error) {
      throw error.at(position(at_));
    }
    if (!value) {
      throw unexpected(fmt::format("'{}'", word.substr(0, 40)), "a decimal or a fraction");
    }
    at_ = end;
    return *value;
  }

  std::string_view line_;
  SourcePosition position_;
  std::size_t at_ = 0;
};

std::vector<Point3> parse_points(std::string_view text, const std::string& name) {
  std::vector<Point3> points;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    PointLine reader(line, {name, number, 1});
    if (reader.holds_point()) points.push_back(reader.point());
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return points;
}

std::string_view name_of(PointClass point_class) {
  constexpr std::array<std::string_view, 3> names{"Out\n", "On\n", "In\n"};
  return names[static_cast<std::size_t>(point_class)];
}

Answer classify_points(Context& context, const Arguments& arguments) {
  // The points first: a slip in them should not wait for a large model.
  const std::vector<Point3> points =
      parse_points(read_points_text(arguments.points),
                   arguments.points == "-" ? std::string("stdin") : arguments.points);
  if (io::openmc::is_geometry_file(arguments.model)) {
    return locate_points(context, arguments.model, points);
  }
  const io::Model model = read(context, arguments.model);
  if (points.size() <= few_points) {
    for (const Point3& point : points) context.print(name_of(classify(model.solid, point)));
    return Answer::Yes;
  }
  const PointClassifier classifier(model.solid, context.evaluate_options());
  context.progress().begin("classify", points.size());
  for (const Point3& point : points) {
    context.print(name_of(classifier(point)));
    context.progress().advance();
    context.progress().check();
  }
  return Answer::Yes;
}

}  // namespace

Command add_classify(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "classify",
      "Is each point in, on or out of the solid? One word a line.\n"
      "Of an OpenMC or MCNP geometry: in which cell, and through which universes?");
  command->add_option("MODEL", arguments->model, "the model")->required();
  command
      ->add_option("--points", arguments->points,
                   "lines \"x y z\" (decimals or fractions), - for stdin; # begins a comment line")
      ->type_name("FILE")
      ->required();
  return {command, [arguments](Context& context) { return classify_points(context, *arguments); }};
}

}  // namespace exactcsg::cli
