// SPDX-License-Identifier: Apache-2.0
// The interface through which the suite tests a catalogue implementation.
#pragma once

#include <memory>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/notes.h"
#include "server/catalogue/visits.h"
#include "support/product_names.h"

namespace vitrine::test {

class CatalogueBackend {
 public:
  virtual ~CatalogueBackend() = default;
  // Opens a new connection to the same catalogue, which is empty at first.
  virtual std::unique_ptr<Catalogue> connect() = 0;
  virtual std::unique_ptr<NoteCatalogue> connect_notes() = 0;
  virtual std::unique_ptr<VisitCatalogue> connect_visits() = 0;
};

std::unique_ptr<CatalogueBackend> make_catalogue_backend();

}  // namespace vitrine::test
