// SPDX-License-Identifier: Apache-2.0
// What a back end of the catalogue supplies to be tested.
#pragma once

#include <memory>

#include "server/catalogue/catalogue.h"

namespace vitrine::test {

class CatalogueBackend {
 public:
  virtual ~CatalogueBackend() = default;
  // A new connection to the same catalogue, empty at first.
  virtual std::unique_ptr<Catalogue> connect() = 0;
};

std::unique_ptr<CatalogueBackend> make_catalogue_backend();

}  // namespace vitrine::test
