// SPDX-License-Identifier: Apache-2.0
#include "server/store/new_public_files.h"

#include "server/store/change.h"

namespace vitrine::server {

std::vector<ModelId> NewPublicFiles::find() {
  const auto revision = catalogue_.revision();
  if (!revision || revision_ == *revision) return {};
  const auto page = catalogue_.search({.limit = kNewest});
  if (!page) return {};
  std::vector<ModelId> found;
  std::set<Sha256> seen;
  for (const ModelRecord& model : page->models) {
    const Sha256 file = public_view(model).file;
    if (!seen_.contains(file)) found.push_back(model.id);
    seen.insert(file);
  }
  seen_ = std::move(seen);
  revision_ = *revision;
  return found;
}

}  // namespace vitrine::server
