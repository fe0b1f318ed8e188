// SPDX-License-Identifier: Apache-2.0
// What a back end of the object store supplies to be tested.
#pragma once

#include <memory>

#include "server/store/object_store.h"

namespace vitrine::test {

class ObjectStoreBackend {
 public:
  virtual ~ObjectStoreBackend() = default;
  // A new connection to the same store, empty at first.
  virtual std::unique_ptr<ObjectStore> connect() = 0;
};

std::unique_ptr<ObjectStoreBackend> make_object_store_backend();

}  // namespace vitrine::test
