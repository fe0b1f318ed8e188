// SPDX-License-Identifier: Apache-2.0
// Reads the values of one attribute of the base mesh. Draco predicts a vertex's value from
// parallelograms [TG98] that the vertex forms with neighbours. Internal to codec/base.
#pragma once

#include <vector>

#include "codec/base/coded_order.h"
#include "codec/base/corner_table.h"
#include "codec/core/byte_cursor.h"
#include "codec/core/expected.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Reads one value per vertex of `table`, and leaves `in` after the last value. `order` must have a
// rank for each vertex. Returns the values, indexed by vertex. Fails (kBadInput) if the bytes are
// damaged, and (kUnsupported) if they use a prediction method that this codec's encoder never uses.
Expected<std::vector<Vec3i>> read_values(ByteReader& in, const CornerTable& table,
                                         const CodedOrder& order);

}  // namespace vitrine::inline codec
