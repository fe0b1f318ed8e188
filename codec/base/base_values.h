// SPDX-License-Identifier: Apache-2.0
// Reads the values of an attribute of the base mesh. Draco predicts each value from the
// parallelograms [TG98] of its vertex. Internal to codec/base.
#pragma once

#include <vector>

#include "codec/base/coded_order.h"
#include "codec/base/corner_table.h"
#include "codec/core/byte_cursor.h"
#include "codec/core/expected.h"
#include "codec/core/vec.h"

namespace vitrine::inline codec {

// Reads one value per vertex of `table`, and leaves `in` behind them. `order` must have a rank for
// each vertex. Returns the values by vertex. Fails (kBadInput) if they are damaged, and
// (kUnsupported) if they are predicted in another way than by this codec's encoder.
Expected<std::vector<Vec3i>> read_values(ByteReader& in, const CornerTable& table,
                                         const CodedOrder& order);

}  // namespace vitrine::inline codec
