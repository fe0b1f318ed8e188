// SPDX-License-Identifier: Apache-2.0
#include "server/backup/repair.h"

#include "server/backup/tar.h"
#include "server/store/disk_space.h"

namespace vitrine::server {
namespace {

Expected<void> put_back(Installation& installation, const Sha256& name,
                        std::span<const std::uint8_t> bytes) {
  const auto lock = installation.store->lock();
  if (!lock) return tl::unexpected(lock.error());
  const auto put = installation.store->put(name, bytes);
  return put ? Expected<void>() : tl::unexpected(put.error());
}

// Increments the versions of all models with this file, so that daemons open the repaired file.
// Ignores kState: it means that another caller has changed the model, which then has a new version
// already.
Expected<void> tell_daemons(Catalogue& catalogue, const Sha256& name) {
  const auto files = catalogue.files();
  if (!files) return tl::unexpected(files.error());
  for (const NamedFile& file : *files) {
    if (file.file != name) continue;
    const auto model = catalogue.find(file.model);
    if (!model) return tl::unexpected(model.error());
    if (!*model) continue;
    const auto told = catalogue.update(**model, std::nullopt);
    if (!told && told.error().code != ErrorCode::kState) return told;
  }
  return {};
}

}  // namespace

CopySource copies_in_backup(const std::filesystem::path& file) {
  return [file](const std::set<Sha256>& wanted, const TakeCopy& take) -> Expected<void> {
    auto tar = TarReader::open(file);
    if (!tar) return tl::unexpected(tar.error());
    for (;;) {
      const auto entry = tar->next();
      if (!entry) return tl::unexpected(entry.error());
      if (!*entry) return {};
      if (!(*entry)->name.starts_with("objects/")) continue;
      const Sha256 name = sha256((*entry)->bytes);
      if (!wanted.contains(name)) continue;
      if (auto taken = take(name, (*entry)->bytes); !taken) return taken;
    }
  };
}

CopySource copies_in_store(const ObjectStore& store) {
  return [&store](const std::set<Sha256>& wanted, const TakeCopy& take) -> Expected<void> {
    for (const Sha256& name : wanted) {
      const auto object = store.open(name);
      if (!object && object.error().code == ErrorCode::kState)
        continue;  // the copy in this source is damaged, too
      if (!object) return tl::unexpected(object.error());
      if (*object == nullptr) continue;
      const auto bytes = (*object)->read(0, (*object)->size());
      if (!bytes) return tl::unexpected(bytes.error());
      if (auto taken = take(name, *bytes); !taken) return taken;
    }
    return {};
  };
}

Expected<RepairReport> repair(Installation& installation, const CopySource& source,
                              std::uint64_t disk_reserve) {
  auto found = scrub(*installation.store, *installation.catalogue);
  if (!found) return tl::unexpected(found.error());
  std::vector<NamedFile> files;
  for (const DamagedFile& damaged : found->damaged)
    files.push_back(damaged.file);
  if (auto fits = check_reserve(installation, files, disk_reserve); !fits)
    return tl::unexpected(fits.error());
  std::set<Sha256> wanted;
  for (const DamagedFile& damaged : found->damaged)
    wanted.insert(damaged.file.file);
  std::set<Sha256> repaired;
  const auto take = [&](const Sha256& name, std::span<const std::uint8_t> bytes) {
    auto done = put_back(installation, name, bytes);
    if (done) done = tell_daemons(*installation.catalogue, name);
    if (done) repaired.insert(name);
    return done;
  };
  if (!wanted.empty()) {
    if (auto done = source(wanted, take); !done) return tl::unexpected(done.error());
  }
  RepairReport report{.objects = found->objects, .repaired = {}, .damaged = {}};
  for (const DamagedFile& damaged : found->damaged)
    (repaired.contains(damaged.file.file) ? report.repaired : report.damaged).push_back(damaged);
  return report;
}

}  // namespace vitrine::server
