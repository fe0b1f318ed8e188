// SPDX-License-Identifier: Apache-2.0
#include "server/store/installation.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "codec/files/atomic_file.h"
#include "server/catalogue/find_faults.h"
#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/private_file.h"
#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "server/store/file_lock.h"
#include "server/store/file_store.h"
#include "server/store/s3_store.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNextStep = "give the folder of an installation, or start vitrined with ";

// Whether a folder without an installation may contain this entry. Such entries are the remains of
// an interrupted start, the demo's scanner, and "lost+found" at the root of a disk.
bool may_come_first(std::string_view name) {
  constexpr std::array<std::string_view, 4> kNames{"objects", kDaemonLock, "demo", "lost+found"};
  return std::ranges::count(kNames, name) > 0;
}

struct OpenCatalogue {
  // With PostgreSQL, `database` and `jobs` refer to the same object. With SQLite, each has its own
  // connection.
  std::shared_ptr<sql::Database> database, jobs;
  std::shared_ptr<sql::Database> tokens;  // always has its own connections
  TakeLock lock;                          // acquires the store's lock
};

Expected<OpenCatalogue> open_in_folder(const fs::path& folder) {
  auto database = sqlite::open_database(folder / kCatalogueFile);
  if (!database) return tl::unexpected(database.error());
  auto jobs = sqlite::open_database(folder / kCatalogueFile);
  if (!jobs) return tl::unexpected(jobs.error());
  auto tokens = sqlite::open_database(folder / kCatalogueFile);
  if (!tokens) return tl::unexpected(tokens.error());
  return OpenCatalogue{std::move(*database), std::move(*jobs), std::move(*tokens),
                       [folder]() -> Expected<std::shared_ptr<const ExclusiveLock>> {
                         if (auto lock = lock_folder(folder)) return lock;
                         return fail(ErrorCode::kIo,
                                     fmt::format("cannot lock {}: {}; check it", folder.string(),
                                                 std::strerror(errno)));
                       }};
}

Expected<OpenCatalogue> open_catalogue(const InstallationPlace& place) {
  if (place.catalogue.empty()) return open_in_folder(place.folder);
  auto database = postgres::open_database(place.catalogue);
  if (!database) return tl::unexpected(database.error());
  return OpenCatalogue{database->database, database->database, database->separate, database->lock};
}

Expected<std::unique_ptr<ObjectStore>> open_store(const InstallationPlace& place, TakeLock lock) {
  if (place.store.empty()) {
    auto files = FileStore::open(place.folder / "objects");
    if (!files) return tl::unexpected(files.error());
    return std::make_unique<FileStore>(std::move(*files));
  }
  auto address = S3Address::parse(place.store);
  if (!address) return tl::unexpected(address.error());
  return S3Store::open({.address = std::move(*address),
                        .keys = {place.access_key, place.secret_key},
                        .copies = place.folder,
                        .lock = std::move(lock)});
}

}  // namespace

Expected<void> check_installation(const fs::path& folder) {
  std::error_code unknown;  // on an error, the loop continues with the parent folder
  fs::path made = folder / kCatalogueFile;
  while (!fs::exists(folder_of(made), unknown) && made != folder_of(made))
    made = folder_of(made);
  return check_writable(made);
}

Expected<void> make_data_folder(const fs::path& folder) {
  if (auto usable = check_installation(folder); !usable) return usable;
  std::error_code error;
  create_private_folder(folder, error);
  if (!error) return {};
  return fail(ErrorCode::kIo, fmt::format("cannot create {}: {}; {}", folder.string(),
                                          error.message(), next_step(error.value())));
}

Expected<void> check_data_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::exists(folder / kCatalogueFile, error)) return {};
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    if (may_come_first(at->path().filename().string())) continue;
    return fail(ErrorCode::kIo, folder.string() + " contains other files and no catalogue; " +
                                    kNextStep + "an empty one once");
  }
  if (!error) return {};
  return fail(ErrorCode::kIo, "cannot open the data folder " + folder.string() + ": " +
                                  error.message() + "; " + kNextStep + "this one once");
}

Expected<void> check_place(const InstallationPlace& place) {
  if (place.store.empty()) return {};
  const auto address = S3Address::parse(place.store);
  return address ? Expected<void>() : tl::unexpected(address.error());
}

Expected<std::vector<std::string>> find_catalogue_faults(const InstallationPlace& place) {
  return place.catalogue.empty() ? sqlite::find_faults(place.folder / kCatalogueFile)
                                 : postgres::find_faults(place.catalogue);
}

Expected<Installation> open_installation(const InstallationPlace& place) {
  if (auto made = make_data_folder(place.folder); !made) return tl::unexpected(made.error());
  auto catalogue = open_catalogue(place);
  if (!catalogue) return tl::unexpected(catalogue.error());
  auto store = open_store(place, catalogue->lock);
  if (!store) return tl::unexpected(store.error());
  return Installation{.place = place,
                      .store = std::move(*store),
                      .catalogue = make_catalogue(catalogue->database),
                      .tokens = make_catalogue(catalogue->tokens),
                      .jobs = make_jobs(catalogue->jobs),
                      .notes = make_notes(catalogue->database),
                      .visits = make_visits(catalogue->jobs),
                      .database = catalogue->database};
}

}  // namespace vitrine::server
