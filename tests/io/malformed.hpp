// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

// Rows of tables of texts that a reader must refuse, each with the error and the place in the text.

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "exactcsg/support/error.hpp"

namespace exactcsg::io::test {

struct Malformed {
  const char* name;
  std::string text;
  ErrorId id;
  std::size_t line;
  std::size_t column;
};

inline void PrintTo(const Malformed& m, std::ostream* stream) { *stream << m.name; }

// read(text, file): the reader of such texts, of which `file` is the name.
template <class Read>
void expect_refusal(const Malformed& m, const std::string& file, Read read) {
  try {
    read(m.text, file);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(describe(error.id()).code, describe(m.id).code) << error.what();
    ASSERT_TRUE(error.details().position) << error.what();
    EXPECT_EQ(error.details().position->file, file);
    EXPECT_EQ(error.details().position->line, m.line) << error.what();
    EXPECT_EQ(error.details().position->column, m.column) << error.what();
  }
}

}  // namespace exactcsg::io::test
