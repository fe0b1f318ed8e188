// SPDX-License-Identifier: Apache-2.0
#include "server/store/installation.h"

#include "codec/files/atomic_file.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_jobs.h"
#include "server/store/file_store.h"

namespace vitrine {

Expected<void> check_installation(const std::filesystem::path& folder) {
  std::error_code unknown;  // is as good as not there: then the folder above is looked at
  std::filesystem::path made = folder / "catalogue.sqlite";
  while (!std::filesystem::exists(folder_of(made), unknown) && made != folder_of(made))
    made = folder_of(made);
  return check_writable(made);
}

Expected<Installation> open_installation(const std::filesystem::path& folder) {
  if (auto usable = check_installation(folder); !usable) return tl::unexpected(usable.error());
  auto store = FileStore::open(folder / "objects");
  if (!store) return tl::unexpected(store.error());
  auto catalogue = open_sqlite_catalogue(folder / "catalogue.sqlite");
  if (!catalogue) return tl::unexpected(catalogue.error());
  auto jobs = open_sqlite_jobs(folder / "catalogue.sqlite");
  if (!jobs) return tl::unexpected(jobs.error());
  return Installation{std::make_unique<FileStore>(std::move(*store)), std::move(*catalogue),
                      std::move(*jobs)};
}

}  // namespace vitrine
