// SPDX-License-Identifier: Apache-2.0
#include "server/store/installation.h"

#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/file_store.h"

namespace vitrine {

Expected<Installation> open_installation(const std::filesystem::path& folder) {
  auto store = FileStore::open(folder / "objects");
  if (!store) return tl::unexpected(store.error());
  auto catalogue = open_sqlite_catalogue(folder / "catalogue.sqlite");
  if (!catalogue) return tl::unexpected(catalogue.error());
  return Installation{std::make_unique<FileStore>(std::move(*store)), std::move(*catalogue)};
}

}  // namespace vitrine
