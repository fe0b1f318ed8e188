// SPDX-License-Identifier: Apache-2.0
// The interface through which the suite tests an object store implementation.
#pragma once

#include <memory>

#include "server/store/object_store.h"
#include "support/product_names.h"

namespace vitrine::test {

class ObjectStoreBackend {
 public:
  virtual ~ObjectStoreBackend() = default;
  // Opens a new connection to the same store, which is empty at first.
  virtual std::unique_ptr<ObjectStore> connect() = 0;
};

std::unique_ptr<ObjectStoreBackend> make_object_store_backend();

}  // namespace vitrine::test
