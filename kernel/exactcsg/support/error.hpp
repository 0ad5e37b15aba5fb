// SPDX-License-Identifier: Apache-2.0
#pragma once

// Every error the library reports is one typed exception: an id of the error catalogue
// (docs/errors.md), what was found, what was expected, what to do, and, where input text is
// to blame, the position in it. The library never prints, never aborts, never exits.

#include <cstddef>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace exactcsg {

// One line of the catalogue. `code` is stable and is what scripts may rely on.
enum class ErrorId {
#define EXACTCSG_ERROR(name, code, exit_code, title, remedy) name,
#include "exactcsg/support/error_catalogue.inc"
#undef EXACTCSG_ERROR
};

struct ErrorDescription {
  ErrorId id;
  std::string_view code;    // "E0203"
  int exit_code;            // what the command exits with: 1, 2 or 3
  std::string_view title;   // what is wrong, in general
  std::string_view remedy;  // what to do about it
};

// The whole catalogue, in order of its codes. COST: O(1), static storage.
std::span<const ErrorDescription> error_catalogue() noexcept;
const ErrorDescription& describe(ErrorId id) noexcept;

// Lines and columns count from 1; a column counts bytes. 0 means "not known".
struct SourcePosition {
  std::string file;
  std::size_t line = 0;
  std::size_t column = 0;
};

class Error : public std::exception {
 public:
  struct Details {
    std::string found;     // what was there ("3 facets share the edge (0,0,0)-(1,0,0)")
    std::string expected;  // what should have been there
    std::optional<SourcePosition> position{};
  };

  Error(ErrorId id, Details details);

  ErrorId id() const noexcept { return id_; }
  const Details& details() const noexcept { return details_; }
  // "file:line:column: error[E0203]: title: found ..., expected ...; remedy"
  const char* what() const noexcept override { return message_.c_str(); }

  // The same error, said of a place in a file; keeps a position that is already there.
  Error at(SourcePosition position) const;

 private:
  ErrorId id_;
  Details details_;
  std::string message_;
};

}  // namespace exactcsg
