// SPDX-License-Identifier: GPL-3.0-or-later
// Malformed and hostile input: every file is refused by its id, at its position, with exit code 2,
// within the time and memory limits, without a crash and without output on stdout.

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ostream>
#include <regex>
#include <string_view>

#include "cli/run_command.hpp"

namespace exactcsg::cli_test {
namespace {

using namespace std::string_view_literals;

struct Malformed {
  const char* name;
  std::string_view text;
  const char* code;
  int line;  // 0: without line and column
  int column;
};

void PrintTo(const Malformed& m, std::ostream* stream) { *stream << m.name; }

const Malformed table[] = {
#include "cli/malformed/cases.inc"
};

// stderr has exactly "FILE:LINE:COLUMN: error[CODE]: ...", stdout nothing.
void expect_refusal(const Finished& finished, const std::string& file, const std::string& code,
                    int line, int column) {
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  std::string place = file;
  if (line != 0) place += ":" + std::to_string(line) + ":" + std::to_string(column);
  EXPECT_NE(finished.err.find(place + ": error[" + code + "]: "), std::string::npos)
      << "expected " << place << ": error[" << code << "], found\n"
      << finished.err;
  EXPECT_LT(finished.err.size(), 2000U) << "a message must not print the file";
}

class MalformedText : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedText, IsRefusedByName) {
  const Folder folder;
  const std::string file = folder.write(std::string(GetParam().name) + ".csg", GetParam().text);
  expect_refusal(run_command({"measure", file}), file, GetParam().code, GetParam().line,
                 GetParam().column);
}

INSTANTIATE_TEST_SUITE_P(Table, MalformedText, testing::ValuesIn(table),
                         [](const auto& info) { return std::string(info.param.name); });

// The number that the issue asks for.
TEST(MalformedTable, HasAtLeastSixtyRows) { EXPECT_GE(std::size(table), 60U); }

// One model with every kind of node, cut at every character: each piece is either a whole file
// (it ends between top-level statements) or refused as truncated, at a place in its last line or at
// the unfinished string or comment. No piece is answered as if it were whole.
TEST(MalformedFiles, CutAtEveryNode) {
  const std::string text =
      "group() {\n"
      "\tmultmatrix([[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {\n"
      "\t\tdifference() {\n"
      "\t\t\tcube(size = [4, 4, 4], center = true);\n"
      "\t\t\tsphere($fn = 8, $fa = 12, $fs = 2, r = 2);\n"
      "\t\t\tlinear_extrude(height = 9, center = true, convexity = 1, scale = [1, 1]) {\n"
      "\t\t\t\tcircle($fn = 6, $fa = 12, $fs = 2, r = 1);\n"
      "\t\t\t}\n"
      "\t\t}\n"
      "\t}\n"
      "}\n";
  const Folder folder;
  // Cut before and after every node's name, argument list, brace and semicolon.
  std::size_t cuts = 0;
  for (std::size_t end = 1; end + 2 < text.size(); ++end) {
    const char before = text[end - 1];
    if (before != '(' && before != ')' && before != '{' && before != '}' && before != ';' &&
        before != ',' && before != '=') {
      continue;
    }
    ++cuts;
    const std::string piece = text.substr(0, end);
    const std::string file = folder.write("cut.csg", piece);
    // Everything after the last character is missing: the end of the text is the place.
    const auto line = 1 + std::count(piece.begin(), piece.end(), '\n');
    const auto column = end - (piece.find_last_of('\n') + 1) + 1;
    expect_refusal(run_command({"info", file}), file, "E0102", static_cast<int>(line),
                   static_cast<int>(column));
  }
  EXPECT_GT(cuts, 60U);
}

// Nesting costs no stack: a model a million groups deep is answered (the cube of side 1), and the
// same without its closing braces is refused.
TEST(MalformedFiles, AMillionDeep) {
  constexpr int depth = 1'000'000;
  const Folder folder;
  std::string open;
  for (int i = 0; i < depth; ++i) open += "group(){";
  const std::string file =
      folder.write("deep.csg", open + "cube(size=1);" + std::string(depth, '}'));
  const Finished finished = run_command({"measure", file});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.out.find("volume           1\n"), std::string::npos) << finished.out;
  const std::string cut = folder.write("cut.csg", open);
  expect_refusal(run_command({"measure", cut}), cut, "E0102", 1, static_cast<int>(open.size()) + 1);
}

// A million brackets of one value are refused, as a vector of vectors of ... has no meaning.
TEST(MalformedFiles, AMillionBrackets) {
  const Folder folder;
  const std::string file =
      folder.write("brackets.csg", "cube(size = " + std::string(1'000'000, '['));
  const Finished finished = run_command({"measure", file});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("error[E0801]"), std::string::npos) << finished.err;
}

TEST(MalformedFiles, ANumberOfAMillionDigits) {
  const Folder folder;
  const std::string file =
      folder.write("long.csg", "sphere(r = " + std::string(1'000'000, '7') + ");\n");
  expect_refusal(run_command({"measure", file}), file, "E0106", 1, 12);
}

TEST(MalformedFiles, MissingFile) {
  const Folder folder;
  const std::string file = folder / "missing.csg";
  expect_refusal(run_command({"measure", file}), file, "E0002", 0, 0);
}

TEST(MalformedFiles, DanglingLink) {
  const Folder folder;
  const std::string file = folder / "link.csg";
  std::filesystem::create_symlink(folder / "nowhere.csg", file);
  expect_refusal(run_command({"measure", file}), file, "E0002", 0, 0);
}

TEST(MalformedFiles, Directory) {
  const Folder folder;
  const std::string file = folder / "folder.csg";
  std::filesystem::create_directory(file);
  expect_refusal(run_command({"measure", file}), file, "E0002", 0, 0);
}

// Not a regular file, and nobody writes to it: it must not be waited for.
TEST(MalformedFiles, Fifo) {
  const Folder folder;
  const std::string file = folder / "fifo.csg";
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  expect_refusal(run_command({"measure", file, "--time-limit", "5"}), file, "E0002", 0, 0);
}

TEST(MalformedFiles, Device) {
  const Folder folder;
  const std::string file = folder / "device.csg";
  std::filesystem::create_symlink("/dev/zero", file);
  expect_refusal(run_command({"measure", file}), file, "E0002", 0, 0);
}

// Root may read everything, so the command is run as nobody; from a copy, since the build folder
// may be closed to others.
TEST(MalformedFiles, NoPermission) {
  namespace fs = std::filesystem;
  const Folder folder;
  fs::permissions(folder.path(), fs::perms{0755});
  const std::string open = folder.write("open.csg", "cube(size = 1);\n");
  const std::string secret = folder.write("secret.csg", "cube(size = 1);\n");
  fs::permissions(secret, fs::perms::none);
  std::vector<std::string> words;
  if (geteuid() == 0) {
    words = {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
  }
  words.push_back(folder / "exactcsg");
  fs::copy_file(program(), words.back());
  fs::permissions(words.back(), fs::perms{0755});
  words.insert(words.end(), {"measure", open});
  EXPECT_EQ(run_program(words).exit_code, 0) << run_program(words).err;
  words.back() = secret;
  expect_refusal(run_program(words), secret, "E0002", 0, 0);
}

TEST(MalformedFiles, UnknownEnding) {
  const Folder folder;
  for (const char* name : {"model.step", "model", "model.csg.bak", "model.3mf"}) {
    const std::string file = folder.write(name, "cube(size = 1);\n");
    expect_refusal(run_command({"measure", file}), file, "E0004", 0, 0);
  }
}

// Mesh files: text cut short, vertices that do not exist, open and empty meshes.
TEST(MalformedFiles, Meshes) {
  const Folder folder;
  const auto refuse = [&](const char* name, std::string_view text, const char* code) {
    const std::string file = folder.write(name, text);
    const Finished finished = run_command({"measure", file});
    EXPECT_EQ(finished.exit_code, 2) << name;
    EXPECT_EQ(finished.out, "") << name;
    EXPECT_NE(finished.err.find("error[" + std::string(code) + "]"), std::string::npos)
        << name << ": " << finished.err;
  };
  refuse("empty.off", "", "E0005");
  refuse("cut.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n", "E0102");
  refuse("range.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "E0209");
  refuse("open.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "E0204");
  refuse("empty.stl", "", "E0005");
  refuse("empty.obj", "", "E0005");
  refuse("empty.ply", "", "E0005");
  refuse("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "E0204");
}

// OpenSCAD's own complaint is passed on.
TEST(MalformedFiles, ScadWithASyntaxError) {
  const Folder folder;
  const std::string file = folder.write("slip.scad", "cube([1, 1, 1);\n");
  const Finished finished = run_command({"measure", file});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.err.find("error[E0402]"), std::string::npos) << finished.err;
  EXPECT_NE(finished.err.find("syntax error"), std::string::npos) << finished.err;
}

}  // namespace
}  // namespace exactcsg::cli_test
