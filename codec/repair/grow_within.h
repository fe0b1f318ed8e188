// SPDX-License-Identifier: Apache-2.0
// Grows a vector whose largest possible size is known.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vitrine::inline codec {

// Reserves room for `size` elements, which must not exceed `most`. The capacity doubles, as with
// push_back(), but never exceeds `most`. Many calls therefore take linear time, and the vector
// never gets larger than the file's data can require.
template <class T>
void grow_within(std::vector<T>& column, std::size_t size, std::size_t most) {
  if (size > column.capacity())
    column.reserve(std::max(size, std::min(2 * column.capacity(), most)));
}

}  // namespace vitrine::inline codec
