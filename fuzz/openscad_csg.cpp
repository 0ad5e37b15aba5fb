// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever bytes a .csg file holds, the reader answers with a model or with an exactcsg::Error.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "exactcsg/io/model.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Longer inputs find nothing that shorter ones do not, only later.
  constexpr std::size_t longest = 1U << 12U;
  if (size > longest) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const auto rounding :
       {exactcsg::io::Rounding::AsWritten, exactcsg::io::Rounding::OpenScadGrid}) {
    try {
      exactcsg::io::ReadOptions options;
      options.rounding = rounding;
      static_cast<void>(exactcsg::io::read_openscad_csg(text, "fuzz.csg", options));
    } catch (const exactcsg::Error&) {
    }
  }
  return 0;
}
