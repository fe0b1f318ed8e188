// SPDX-License-Identifier: Apache-2.0
// Grows a vector whose largest possible size is known.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vitrine::inline codec {

// Makes room for `size` elements, which must be at most `most`. The capacity doubles, as with
// push_back(), but stays within `most`. So many calls take linear time, and no memory lies unused
// beyond what the file can fill.
template <class T>
void grow_within(std::vector<T>& column, std::size_t size, std::size_t most) {
  if (size > column.capacity())
    column.reserve(std::max(size, std::min(2 * column.capacity(), most)));
}

}  // namespace vitrine::inline codec
