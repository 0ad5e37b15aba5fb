// SPDX-License-Identifier: GPL-3.0-or-later
// The house rules, tested on every file of ours, and the test itself on planted violations.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "layers/source_rules.hpp"

namespace exactcsg::house {
namespace {

const std::filesystem::path root = EXACTCSG_SOURCE_DIR;

std::string listed(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& v : violations) {
    text += v.file + ":" + std::to_string(v.line) + ": " + v.what + "\n";
  }
  return text;
}

bool is_code(const std::filesystem::path& file) {
  return file.extension() == ".hpp" || file.extension() == ".cpp" || file.extension() == ".inc";
}

TEST(Layers, NoFileIncludesAgainstTheOrderPrintsOrAborts) {
  std::size_t checked = 0;
  std::vector<Violation> violations;
  for (const auto& file : our_files(root)) {
    if (!is_code(file) || layer_of(file).empty()) continue;
    ++checked;
    const auto found = layer_violations(file, read_text(root / file));
    violations.insert(violations.end(), found.begin(), found.end());
  }
  EXPECT_EQ(listed(violations), "");
  EXPECT_GT(checked, 20U) << "the sources were not found below " << root;
}

TEST(Layers, EveryCodeFileOfTheRoomsIsInALayer) {
  for (const auto& file : our_files(root)) {
    const std::string room = file.begin()->string();
    if (!is_code(file) || room != "kernel") continue;
    EXPECT_TRUE(std::ranges::count(std::array{"support", "number", "skeleton", "csg", "gdt",
                                              "planar", "domain", "measure", "solid"},
                                   layer_of(file)) == 1)
        << file << " is in the unknown layer '" << layer_of(file) << "'";
  }
}

struct Planted {
  const char* file;
  const char* text;
  bool forbidden;
};

// Each forbidden line must be found, and its innocent relatives must not be.
TEST(Layers, PlantedViolationsAreFound) {
  const Planted cases[] = {
      {"kernel/exactcsg/number/a.hpp", "#include \"exactcsg/csg/tree.hpp\"\n", true},
      {"kernel/exactcsg/number/a.hpp", "  #  include <exactcsg/solid/solid.hpp>\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include \"exactcsg/io/model.hpp\"\n", true},
      {"io/exactcsg/io/a.cpp", "#include \"exactcsg/verify/report.hpp\"\n", true},
      {"verify/exactcsg/verify/a.cpp", "#include \"cli/command.hpp\"\n", true},
      {"kernel/exactcsg/csg/a.hpp", "#include \"exactcsg/attic/a.hpp\"\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include <CGAL/Nef_polyhedron_3.h>\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include <CGAL/no_such_header_at_all.h>\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include <OpenMesh/Core/IO/MeshIO.hh>\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include <iostream>\n", true},
      {"io/exactcsg/io/a.cpp", "#include <iostream>\n", true},
      {"io/exactcsg/io/a.cpp", "void f() { std::cerr << 1; }\n", true},
      {"kernel/exactcsg/gdt/a.cpp", "void f() { std::abort(); }\n", true},
      {"verify/exactcsg/verify/a.cpp", "void f() { exit (1); }\n", true},
      {"io/exactcsg/io/a.cpp", "void f() { printf(\"x\"); }\n", true},
      {"kernel/exactcsg/solid/a.cpp", "#include \"exactcsg/number/exact.hpp\"\n", false},
      {"kernel/exactcsg/solid/a.cpp", "#include \"exactcsg/solid/solid.hpp\"\n", false},
      {"kernel/exactcsg/solid/a.cpp", "// #include \"exactcsg/io/model.hpp\"\n", false},
      {"kernel/exactcsg/solid/a.cpp", "/* abort()\n exit(1) */ int a = 1'000;\n", false},
      {"kernel/exactcsg/solid/a.cpp", "auto s = \"std::cerr abort()\";\n", false},
      {"kernel/exactcsg/solid/a.cpp", "auto s = R\"x(abort() \" // )x\";\n", false},
      {"io/exactcsg/io/a.cpp", "void f() { snprintf(b, 1, \"x\"); node.exit(); _exit(127); }\n",
       false},
      {"cli/main.cpp", "int main() { std::exit(0); }\n", false},
      {"tests/csg/a.cpp", "#include \"exactcsg/io/model.hpp\"\n", false},
  };
  for (const Planted& planted : cases) {
    EXPECT_EQ(!layer_violations(planted.file, planted.text).empty(), planted.forbidden)
        << planted.file << ": " << planted.text;
  }
}

TEST(Layers, AViolationNamesItsLine) {
  const auto found =
      layer_violations("io/exactcsg/io/a.cpp", "/* two\nlines */\nint a;\nint b = f(abort());\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].line, 4U);
}

TEST(Licences, EveryFileNamesItsLicenceFirst) {
  std::vector<Violation> violations;
  for (const auto& file : our_files(root)) {
    const std::string extension = file.extension().string();
    // Formats that have no comments, and inputs of tests that must be what they are.
    if (extension == ".json" || extension == ".csg" || extension == ".scad" ||
        extension == ".nef3" || extension == ".off" || extension == ".stl" || extension == ".obj" ||
        extension == ".ply" || extension == ".svg" || extension == ".png" || extension == ".html") {
      continue;
    }
    if (file.string().starts_with("fuzz/seeds/")) continue;
    if (file.string().starts_with("examples/expected/")) continue;
    const auto found = licence_violations(file, read_text(root / file));
    violations.insert(violations.end(), found.begin(), found.end());
  }
  EXPECT_EQ(listed(violations), "");
}

TEST(Licences, PlantedViolationsAreFound) {
  EXPECT_TRUE(
      licence_violations("dev", "#!/bin/bash\n# SPDX-License-Identifier: GPL-3.0-or-later\n")
          .empty());
  EXPECT_FALSE(licence_violations("dev", "#!/bin/bash\necho\n").empty());
  EXPECT_FALSE(
      licence_violations("kernel/exactcsg/a.hpp", "// SPDX-License-Identifier: GPL-3.0-or-later\n")
          .empty());
  EXPECT_FALSE(
      licence_violations("io/exactcsg/io/a.hpp", "\n// SPDX-License-Identifier: GPL-3.0-or-later\n")
          .empty());
}

// "[text](path)" and "[text](path#place)" with a path inside the project, outside code blocks.
std::vector<std::string> relative_links(std::string text) {
  std::vector<std::string> links;
  for (auto at = text.find("```"); at != std::string::npos; at = text.find("```")) {
    const auto end = text.find("```", at + 3);
    text.erase(at, end == std::string::npos ? end : end + 3 - at);
  }
  for (auto at = text.find("]("); at != std::string::npos; at = text.find("](", at + 2)) {
    const auto end = text.find_first_of(")# ", at + 2);
    const std::string link = text.substr(at + 2, end - at - 2);
    if (!link.empty() && link.find("://") == std::string::npos) links.push_back(link);
  }
  return links;
}

TEST(Documents, LinksLeadSomewhere) {
  for (const auto& file : our_files(root)) {
    if (file.extension() != ".md") continue;
    for (const std::string& link : relative_links(read_text(root / file))) {
      EXPECT_TRUE(std::filesystem::exists((root / file).parent_path() / link))
          << file << " links to " << link;
    }
  }
  EXPECT_EQ(relative_links("[a](b.md#c) ```[](int x)``` [d](https://e) [f](g/h.md)"),
            (std::vector<std::string>{"b.md", "g/h.md"}));
}

}  // namespace
}  // namespace exactcsg::house
