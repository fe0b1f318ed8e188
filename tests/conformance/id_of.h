// SPDX-License-Identifier: Apache-2.0
// Makes IDs for tests. id_of(1) converts to the ID of a model, job, scan or token, and differs from
// id_of(2).
#pragma once

#include <cstdint>

#include "server/catalogue/id.h"
#include "support/product_names.h"

namespace vitrine::test {

struct TestId {
  std::uint8_t value = 0;

  template <class Tag>
  operator server::Id<Tag>() const {
    server::Ulid bytes{};
    bytes[0] = value;
    return server::Id<Tag>::from_bytes(bytes);
  }
};

inline TestId id_of(std::uint8_t value) {
  return {value};
}

}  // namespace vitrine::test
