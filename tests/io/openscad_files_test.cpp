// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "exactcsg/io/model.hpp"
#include "exactcsg/solid/evaluate.hpp"
#include "exactcsg/solid/measures.hpp"
#include "temporary_folder.hpp"

namespace exactcsg::io {
namespace {

namespace fs = std::filesystem;

class OpenscadFiles : public testing::Test {
 protected:
  static ErrorId refusal(const fs::path& file) {
    try {
      read_model(file);
    } catch (const Error& error) {
      EXPECT_TRUE(error.details().position) << error.what();
      return error.id();
    }
    ADD_FAILURE() << "accepted: " << file;
    return ErrorId::InternalError;
  }
  const exactcsg::test::Folder folder_;
};

TEST_F(OpenscadFiles, AreReadByTheirEnding) {
  const Model model = read_model(folder_.write("part.CSG", "cube(2);\n"));
  EXPECT_EQ(*exact_volume(evaluate(model.solid)), 8);
  EXPECT_EQ(model.name, folder_ / "part.CSG");
}

TEST_F(OpenscadFiles, AreRefusedByName) {
  EXPECT_EQ(refusal(folder_.path()), ErrorId::FileNotReadable);
  EXPECT_EQ(refusal(folder_ / "missing.csg"), ErrorId::FileNotReadable);
  fs::create_directory(folder_ / "folder.csg");
  EXPECT_EQ(refusal(folder_ / "folder.csg"), ErrorId::FileNotReadable);
  EXPECT_EQ(refusal(folder_.write("empty.csg", "")), ErrorId::EmptyFile);
  EXPECT_EQ(refusal(folder_.write("empty.scad", "")), ErrorId::EmptyFile);
  EXPECT_EQ(refusal(folder_.write("zip.csg", "PK\x03\x04 and so on")), ErrorId::NotText);
  EXPECT_EQ(refusal(folder_.write("part.step", "ISO-10303-21;")), ErrorId::UnknownFormat);
  EXPECT_EQ(refusal(folder_.write("part", "cube();")), ErrorId::UnknownFormat);
}

// While it lives, the process has no right that only root has.
class WithoutPrivileges {
 public:
  WithoutPrivileges() : user_(geteuid()) {
    constexpr uid_t nobody = 65534;
    EXPECT_EQ(seteuid(user_ == 0 ? nobody : user_), 0);
  }
  WithoutPrivileges(const WithoutPrivileges&) = delete;
  WithoutPrivileges& operator=(const WithoutPrivileges&) = delete;
  ~WithoutPrivileges() { EXPECT_EQ(seteuid(user_), 0); }

 private:
  uid_t user_;
};

TEST_F(OpenscadFiles, ThatMayNotBeReadAreRefused) {
  // Not below the build folder, whose own parents may be closed to others.
  std::string folder = (fs::temp_directory_path() / "exactcsg_test_XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  fs::permissions(folder, fs::perms{0755});
  const fs::path file = fs::path(folder) / "secret.csg";
  std::ofstream(file) << "cube();";
  fs::permissions(file, fs::perms::none);
  {
    const WithoutPrivileges guard;
    EXPECT_TRUE(fs::exists(file));
    EXPECT_FALSE(std::ifstream(file));
    EXPECT_EQ(refusal(file), ErrorId::FileNotReadable);
  }
  fs::remove_all(folder);
}

bool has_openscad() { return std::system("openscad --version >/dev/null 2>&1") == 0; }  // NOLINT

TEST_F(OpenscadFiles, SourcesGoThroughOpenscad) {
  if (!has_openscad()) GTEST_SKIP() << "openscad is not installed";
  const Model model = read_model(folder_.write(
      "part.scad", "echo(\"hello\"); translate([1, 2, 3]) cube([1, 2, h]); // h is not known\n"));
  EXPECT_EQ(*exact_volume(evaluate(model.solid)), 2);  // an unknown size is 1
  EXPECT_THAT(model.front_end_messages, testing::HasSubstr("hello"));
  EXPECT_THAT(model.warnings, testing::Contains(testing::Field(
                                  &Warning::text, testing::HasSubstr("unknown variable"))));
}

TEST_F(OpenscadFiles, SourcesThatMakeNothingAreEmpty) {
  if (!has_openscad()) GTEST_SKIP() << "openscad is not installed";
  const Model model = read_model(folder_.write("part.scad", "if (false) cube();\n"));
  EXPECT_TRUE(model.solid.is_empty());
  EXPECT_FALSE(model.warnings.empty());
}

// OpenSCAD exits with 0 after a failed assertion.
TEST_F(OpenscadFiles, ErrorsInSourcesAreShown) {
  if (!has_openscad()) GTEST_SKIP() << "openscad is not installed";
  EXPECT_EQ(refusal(folder_.write("assert.scad", "cube(); assert(1 > 2); sphere();")),
            ErrorId::OracleFailed);
  EXPECT_EQ(refusal(folder_.write("syntax.scad", "cube(")), ErrorId::OracleFailed);
  EXPECT_EQ(refusal(folder_.write("-o.scad", "cube(")), ErrorId::OracleFailed);
  EXPECT_EQ(refusal(folder_.write("node.scad", "linear_extrude(1) import(\"a.svg\");")),
            ErrorId::UnsupportedNode);
}

TEST_F(OpenscadFiles, WithoutOpenscadSourcesAreRefused) {
  const fs::path file = folder_.write("part.scad", "cube();");
  const char* const before = std::getenv("PATH");
  const std::string path = before != nullptr ? before : "";
  setenv("PATH", "/nonexistent", 1);
  EXPECT_THROW(
      {
        try {
          read_model(file);
        } catch (const Error& error) {
          EXPECT_EQ(error.id(), ErrorId::OracleUnavailable);
          throw;
        }
      },
      Error);
  setenv("PATH", path.c_str(), 1);
}

// Every model of the project's own data is read.
TEST(OpenscadData, IsRead) {
  std::size_t count = 0;
  for (const auto& entry :
       fs::directory_iterator(fs::path(EXACTCSG_SOURCE_DIR) / "data/openscad")) {
    if (entry.path().extension() != ".csg") continue;
    ++count;
    EXPECT_NO_THROW({
      const Model model = read_model(entry.path());
      EXPECT_GT(model.primitives, 0U) << entry.path();
    }) << entry.path();
  }
  EXPECT_GE(count, 30U);
}

}  // namespace
}  // namespace exactcsg::io
