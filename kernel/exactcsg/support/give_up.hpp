// SPDX-License-Identifier: Apache-2.0
#pragma once

// Memory that is wanted for something else.

#include <vector>

namespace exactcsg {

// Empties a vector and gives its memory back, which an assignment of {} would keep.
template <class T>
void give_up(std::vector<T>& items) noexcept {
  std::vector<T>().swap(items);
}

}  // namespace exactcsg
