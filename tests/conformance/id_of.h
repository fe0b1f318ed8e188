// SPDX-License-Identifier: Apache-2.0
// Ids that a test can tell apart.
#pragma once

#include <array>

#include "server/catalogue/model_id.h"

namespace vitrine::test {

inline ModelId id_of(std::uint8_t value) {
  std::array<std::uint8_t, 16> bytes{};
  bytes[0] = value;
  return ModelId::from_bytes(bytes);
}

}  // namespace vitrine::test
