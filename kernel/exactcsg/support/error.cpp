// SPDX-License-Identifier: Apache-2.0
#include "exactcsg/support/error.hpp"

#include <array>
#include <utility>

namespace exactcsg {

namespace {

constexpr auto catalogue = std::to_array<ErrorDescription>({
#define EXACTCSG_ERROR(name, code, exit_code, title, remedy) \
  ErrorDescription{ErrorId::name, code, exit_code, title, remedy},
#include "exactcsg/support/error_catalogue.inc"
#undef EXACTCSG_ERROR
});

std::string message_of(ErrorId id, const Error::Details& details) {
  const ErrorDescription& description = describe(id);
  std::string text;
  if (details.position) {
    text += details.position->file;
    if (details.position->line != 0) {
      text += ':' + std::to_string(details.position->line) + ':' +
              std::to_string(details.position->column);
    }
    text += ": ";
  }
  text.append("error[").append(description.code).append("]: ").append(description.title);
  if (!details.found.empty()) text.append(": found ").append(details.found);
  if (!details.expected.empty()) text.append(", expected ").append(details.expected);
  text.append("; ").append(description.remedy);
  return text;
}

}  // namespace

std::span<const ErrorDescription> error_catalogue() noexcept { return catalogue; }

const ErrorDescription& describe(ErrorId id) noexcept {
  return catalogue[static_cast<std::size_t>(id)];
}

Error::Error(ErrorId id, Details details)
    : id_(id), details_(std::move(details)), message_(message_of(id_, details_)) {}

Error Error::at(SourcePosition position) const {
  if (details_.position) return *this;
  Details placed = details_;
  placed.position = std::move(position);
  return {id_, std::move(placed)};
}

}  // namespace exactcsg
