// SPDX-License-Identifier: Apache-2.0
// Finds the published models whose public files this process has not seen yet, because it has just
// started or because another process has published them.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "server/catalogue/catalogue.h"

namespace vitrine::server {

// Not thread-safe.
class NewPublicFiles {
 public:
  // Number of models that find() looks at. The gallery shows this many on its first page.
  static constexpr std::uint32_t kNewest = 50;

  explicit NewPublicFiles(Catalogue& catalogue) : catalogue_(catalogue) {}

  // Looks at the newest published models and returns those whose public files the previous call did
  // not see, newest first. The first call returns all of them. If the catalogue cannot be read,
  // returns no models; a later call returns them. Cheap if the catalogue has not changed.
  std::vector<ModelId> find();

 private:
  Catalogue& catalogue_;
  std::optional<std::uint64_t> revision_;  // revision of the catalogue at the last call
  std::set<Sha256> seen_;
};

}  // namespace vitrine::server
