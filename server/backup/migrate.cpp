// SPDX-License-Identifier: Apache-2.0
#include "server/backup/migrate.h"

#include <map>
#include <set>

#include "server/catalogue/copy_catalogue.h"

namespace vitrine::server {
namespace {

using FilesByHash = std::map<Sha256, NamedFile>;  // each file once, even if several models use it

Expected<FilesByHash> named_files(Installation& installation, MigrationReport& report) {
  const auto named = installation.catalogue->files();
  if (!named) return tl::unexpected(named.error());
  report.models = models_in(*named);
  FilesByHash files;
  for (const NamedFile& file : *named)
    files.emplace(file.file, file);
  return files;
}

// Copies the file if it is intact. Returns its state.
Expected<ObjectState> copy_file(const ObjectStore& from, ObjectStore& to, const NamedFile& file) {
  const auto object = from.open(file.file);
  if (!object && object.error().code == ErrorCode::kState) return ObjectState::kDamaged;
  if (!object) return tl::unexpected(object.error());
  if (*object == nullptr) return ObjectState::kMissing;
  const auto bytes = (*object)->read(0, (*object)->size());
  if (!bytes) return tl::unexpected(bytes.error());
  const auto put = to.put(file.file, *bytes);
  return put ? Expected<ObjectState>(ObjectState::kIntact) : tl::unexpected(put.error());
}

bool read_on(std::uint64_t) {
  return true;
}

// Copies the files that are not in `done` yet, and adds them to `done`. If neither side has an
// intact copy of a file, lists the file in the report. If only the destination has one, does not
// add the file to `done`: until both sides are locked, the garbage collection of the destination
// may remove that copy.
Expected<void> copy_files(Installation& from, Installation& to, MigrationReport& report,
                          std::set<Sha256>& done, const MigrationProgress& progress) {
  const auto files = named_files(from, report);
  if (!files) return tl::unexpected(files.error());
  report.files = files->size();
  report.bytes = 0;
  report.damaged.clear();
  for (const auto& [name, file] : *files) {
    report.bytes += file.bytes;
    if (done.contains(name)) continue;
    const auto state = copy_file(*from.store, *to.store, file);
    if (!state) return tl::unexpected(state.error());
    if (*state == ObjectState::kIntact) {
      done.insert(name);
      progress(done.size(), files->size());
      continue;
    }
    const auto there = to.store->check(name, read_on);
    if (!there) return tl::unexpected(there.error());
    if (*there == ObjectState::kIntact) continue;
    report.damaged.push_back({file, *state});
    report.bytes -= file.bytes;
  }
  report.files -= report.damaged.size();
  return {};
}

// Checks that the destination has room for the files. If it does not, reads all files of the
// source, and checks again without the damaged and missing ones, because these are not copied.
Expected<void> check_room(Installation& from, const Installation& to, const StorageLimits& limits) {
  const auto files = distinct_files(*from.catalogue);
  if (!files) return tl::unexpected(files.error());
  auto fits = check_limits(to, *files, limits);
  if (fits || fits.error().code != ErrorCode::kLimit) return fits;
  std::vector<NamedFile> intact;
  const auto keep = [&](const NamedFile& file, ObjectState state) {
    if (state == ObjectState::kIntact) intact.push_back(file);
  };
  if (auto read = scrub(*from.store, *files, read_on, keep); !read) return read;
  return intact.size() == files->size() ? fits : check_limits(to, intact, limits);
}

bool are_same_folder(const Installation& a, const Installation& b) {
  std::error_code unknown;
  return std::filesystem::equivalent(a.place.folder, b.place.folder, unknown);
}

// Whether both installations store their files in the same folder, so that one lock covers both.
bool share_files(const Installation& a, const Installation& b) {
  return a.place.store.empty() && b.place.store.empty() && are_same_folder(a, b);
}

bool are_same(const Installation& a, const Installation& b) {
  return a.place.store == b.place.store && a.place.catalogue == b.place.catalogue &&
         (are_same_folder(a, b) || !(a.place.store.empty() || a.place.catalogue.empty()));
}

}  // namespace

// If a file is removed from the source during the migration, its copy stays at the destination
// until the destination's garbage collection.
Expected<MigrationReport> migrate(Installation& from, Installation& to,
                                  const MigrationProgress& progress, const StorageLimits& limits) {
  if (are_same(from, to))
    return fail(ErrorCode::kState, "source and destination are the same; name another destination");
  if (auto fits = check_room(from, to, limits); !fits) return tl::unexpected(fits.error());
  MigrationReport report;
  std::set<Sha256> done;
  if (auto copied = copy_files(from, to, report, done, progress); !copied)
    return tl::unexpected(copied.error());
  const auto locked = from.store->lock();
  if (!locked) return tl::unexpected(locked.error());
  const auto also_locked = share_files(from, to) ? locked : to.store->lock();
  if (!also_locked) return tl::unexpected(also_locked.error());
  if (auto copied = copy_files(from, to, report, done, progress); !copied)
    return tl::unexpected(copied.error());
  if (auto copied = copy_catalogue(*from.database, *to.database); !copied)
    return tl::unexpected(copied.error());
  return report;
}

}  // namespace vitrine::server
