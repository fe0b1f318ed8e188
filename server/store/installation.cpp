// SPDX-License-Identifier: Apache-2.0
#include "server/store/installation.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "codec/files/atomic_file.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_jobs.h"
#include "server/store/file_store.h"

namespace vitrine {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNextStep = "give the folder of an installation, or start vitrined with ";

// What may lie in a data folder before its catalogue does: what an interrupted start leaves, the
// demo's scanner, and what is at the root of a disk.
bool may_come_first(std::string_view name) {
  constexpr std::array<std::string_view, 3> kNames{"objects", "demo", "lost+found"};
  return std::ranges::count(kNames, name) > 0;
}

}  // namespace

Expected<void> check_installation(const fs::path& folder) {
  std::error_code unknown;  // is as good as not there: then the folder above is looked at
  fs::path made = folder / kCatalogueFile;
  while (!fs::exists(folder_of(made), unknown) && made != folder_of(made))
    made = folder_of(made);
  return check_writable(made);
}

Expected<void> check_data_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / kCatalogueFile, error)) return {};
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    if (may_come_first(at->path().filename().string())) continue;
    return fail(ErrorCode::kIo, folder.string() + " holds other things and no catalogue; " +
                                    kNextStep + "an empty one once");
  }
  if (!error) return {};
  return fail(ErrorCode::kIo, "cannot open the data folder " + folder.string() + ": " +
                                  error.message() + "; " + kNextStep + "this one once");
}

Expected<Installation> open_installation(const fs::path& folder) {
  if (auto usable = check_installation(folder); !usable) return tl::unexpected(usable.error());
  auto store = FileStore::open(folder / "objects");
  if (!store) return tl::unexpected(store.error());
  auto catalogue = open_sqlite_catalogue(folder / kCatalogueFile);
  if (!catalogue) return tl::unexpected(catalogue.error());
  auto jobs = open_sqlite_jobs(folder / kCatalogueFile);
  if (!jobs) return tl::unexpected(jobs.error());
  return Installation{std::make_unique<FileStore>(std::move(*store)), std::move(*catalogue),
                      std::move(*jobs)};
}

}  // namespace vitrine
