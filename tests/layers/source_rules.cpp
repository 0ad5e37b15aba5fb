// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers/source_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

namespace exactcsg::house {

namespace {

constexpr std::array<std::string_view, 12> layers{"support", "number", "skeleton", "csg",
                                                  "gdt",     "planar", "domain",   "measure",
                                                  "solid",   "io",     "verify",   "cli"};

std::optional<std::size_t> rank_of(std::string_view layer) {
  const auto found = std::find(layers.begin(), layers.end(), layer);
  if (found == layers.end()) return std::nullopt;
  return static_cast<std::size_t>(found - layers.begin());
}

bool is_kernel(std::size_t rank) { return rank <= *rank_of("solid"); }

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

// The file named by an #include line, without its quotes or angle brackets.
std::optional<std::string> included(std::string_view line) {
  std::string text = trimmed(line);
  if (text.empty() || text.front() != '#') return std::nullopt;
  text = trimmed(std::string_view(text).substr(1));
  if (!text.starts_with("include")) return std::nullopt;
  text = trimmed(std::string_view(text).substr(7));
  if (text.size() < 2 || (text.front() != '"' && text.front() != '<')) return std::nullopt;
  const auto end = text.find(text.front() == '"' ? '"' : '>', 1);
  return text.substr(1, end == std::string::npos ? end : end - 1);
}

// "exactcsg/csg/tree.hpp" -> "csg", "cli/command.hpp" -> "cli".
std::string layer_of_include(std::string_view name) {
  if (name.starts_with("cli/")) return "cli";
  constexpr std::string_view prefix = "exactcsg/";
  if (!name.starts_with(prefix)) return {};
  name.remove_prefix(prefix.size());
  return std::string(name.substr(0, name.find('/')));
}

// The kernel may use only those parts of CGAL that are under the LGPL; the header itself says
// which.
bool is_gpl_cgal(const std::string& name) {
  const std::string text = read_text("/usr/include/" + name);
  return text.empty() || text.find("SPDX-License-Identifier: GPL") != std::string::npos;
}

bool forbidden_in_kernel(const std::string& name) {
  constexpr std::array<std::string_view, 10> prefixes{
      "OpenMesh/", "CLI/",   "fmt/",    "nlohmann/", "pugixml",
      "kainjow/",  "cstdio", "stdio.h", "fstream",   "filesystem"};
  if (name.starts_with("CGAL/")) return is_gpl_cgal(name);
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return name.starts_with(prefix); });
}

// True if the line calls the function: its name as a whole word, not a member, then "(".
bool calls(std::string_view line, std::string_view function) {
  for (auto at = line.find(function); at != std::string_view::npos;
       at = line.find(function, at + 1)) {
    const bool whole = at == 0 || (!is_word(line[at - 1]) && line[at - 1] != '.' &&
                                   !(at >= 2 && line.substr(at - 2, 2) == "->"));
    auto after = line.find_first_not_of(' ', at + function.size());
    if (whole && after != std::string_view::npos && line[after] == '(') return true;
  }
  return false;
}

bool names(std::string_view line, std::string_view word) {
  for (auto at = line.find(word); at != std::string_view::npos; at = line.find(word, at + 1)) {
    const auto end = at + word.size();
    if ((at == 0 || !is_word(line[at - 1])) && (end == line.size() || !is_word(line[end]))) {
      return true;
    }
  }
  return false;
}

template <class Visit>
void for_each_line(std::string_view text, Visit&& visit) {
  std::size_t number = 1;
  while (!text.empty()) {
    const auto end = text.find('\n');
    visit(number++, text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string without_comments(std::string_view text, bool keep_strings) {
  std::string result;
  result.reserve(text.size());
  std::size_t i = 0;
  const auto starts = [&](std::string_view with) { return text.substr(i).starts_with(with); };
  while (i < text.size()) {
    if (starts("//")) {
      while (i < text.size() && text[i] != '\n') ++i;
    } else if (starts("/*")) {
      const auto end = std::min(text.find("*/", i + 2), text.size());
      for (; i < end; ++i) {
        if (text[i] == '\n') result += '\n';
      }
      i = std::min(i + 2, text.size());
    } else if (starts("R\"") && (i == 0 || !is_word(text[i - 1]))) {
      const auto open = std::min(text.find('(', i), text.size());
      const std::string close = ")" + std::string(text.substr(i + 2, open - i - 2)) + "\"";
      const auto end = std::min(text.find(close, open), text.size());
      for (; i < std::min(end + close.size(), text.size()); ++i) {
        if (keep_strings || text[i] == '\n') result += text[i];
      }
    } else if (text[i] == '"' || (text[i] == '\'' && (i == 0 || !is_word(text[i - 1])))) {
      const char quote = text[i];
      result += text[i++];
      while (i < text.size() && text[i] != quote && text[i] != '\n') {
        if (text[i] == '\\' && i + 1 < text.size()) {
          if (keep_strings) result += text[i];
          ++i;
        }
        if (keep_strings) result += text[i];
        ++i;
      }
      if (i < text.size()) result += text[i++];
    } else {
      result += text[i++];
    }
  }
  return result;
}

std::string layer_of(const std::filesystem::path& relative_path) {
  auto part = relative_path.begin();
  if (part == relative_path.end()) return {};
  const std::string room = part->string();
  if (room == "io" || room == "verify" || room == "cli") return room;
  if (room != "kernel") return {};
  std::advance(part, std::min<std::ptrdiff_t>(2, std::distance(part, relative_path.end())));
  return part == relative_path.end() ? std::string{} : part->string();
}

std::vector<Violation> layer_violations(const std::filesystem::path& relative_path,
                                        std::string_view text) {
  const auto own = rank_of(layer_of(relative_path));
  if (!own) return {};
  std::vector<Violation> violations;
  const auto report = [&](std::size_t line, std::string what) {
    violations.push_back({relative_path.string(), line, std::move(what)});
  };
  for_each_line(without_comments(text, true), [&](std::size_t number, std::string_view line) {
    const auto name = included(line);
    if (!name) return;
    if (const std::string layer = layer_of_include(*name); !layer.empty()) {
      const auto other = rank_of(layer);
      if (!other) {
        report(number, "includes '" + *name + "', which is in no layer");
      } else if (*other > *own) {
        report(number, std::string(layers[*own]) + " includes '" + *name + "' of the layer above");
      }
    }
    if (is_kernel(*own) && forbidden_in_kernel(*name)) {
      report(number, "the kernel must not include '" + *name + "'");
    }
    if (layers[*own] != "cli" && *name == "iostream") report(number, "libraries do not print");
  });
  if (layers[*own] == "cli") return violations;
  for_each_line(without_comments(text, false), [&](std::size_t number, std::string_view line) {
    for (const std::string_view function :
         {"printf", "fprintf", "puts", "fputs", "putchar", "perror", "abort", "exit", "quick_exit",
          "_Exit", "terminate"}) {
      if (calls(line, function)) report(number, "a library calls " + std::string(function));
    }
    for (const std::string_view stream : {"cout", "cerr", "clog"}) {
      if (names(line, stream)) report(number, "a library prints to " + std::string(stream));
    }
  });
  return violations;
}

std::vector<Violation> licence_violations(const std::filesystem::path& relative_path,
                                          std::string_view text) {
  const std::string room = relative_path.begin()->string();
  const std::string wanted = std::string("SPDX-License-Identifier: ") +
                             (room == "kernel" ? "Apache-2.0" : "GPL-3.0-or-later");
  if (text.starts_with("#!")) text.remove_prefix(std::min(text.find('\n') + 1, text.size()));
  if (text.substr(0, text.find('\n')).find(wanted) != std::string_view::npos) return {};
  return {{relative_path.string(), 1, "does not begin with '" + wanted + "'"}};
}

std::vector<std::filesystem::path> our_files(const std::filesystem::path& root) {
  std::vector<std::filesystem::path> files;
  for (const std::string_view room :
       {"kernel", "io", "verify", "cli", "tests", "bench", "fuzz", "examples", "cmake", "docs"}) {
    if (!std::filesystem::is_directory(root / room)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / room)) {
      if (entry.is_regular_file()) files.push_back(std::filesystem::relative(entry.path(), root));
    }
  }
  for (const std::string_view file : {"dev", ".ci/run", "CMakeLists.txt", "README.md",
                                      "CHANGELOG.md", ".editorconfig", ".clang-tidy"}) {
    files.emplace_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace exactcsg::house
