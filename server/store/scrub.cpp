// SPDX-License-Identifier: Apache-2.0
#include "server/store/scrub.h"

#include <fmt/core.h>

#include <algorithm>

namespace vitrine::server {

Expected<std::vector<NamedFile>> distinct_files(Catalogue& catalogue) {
  auto files = catalogue.files();
  if (!files) return files;
  std::ranges::sort(*files, {}, &NamedFile::file);
  const auto is_same = [](const NamedFile& a, const NamedFile& b) { return a.file == b.file; };
  files->erase(std::unique(files->begin(), files->end(), is_same), files->end());
  return files;
}

Expected<void> scrub(const ObjectStore& store, std::span<const NamedFile> files,
                     const OnPiece& on_piece, const OnObject& on_object) {
  for (const NamedFile& file : files) {
    const auto state = store.check(file.file, on_piece);
    if (!state) return tl::unexpected(state.error());
    on_object(file, *state);
  }
  return {};
}

Expected<ScrubReport> scrub(const ObjectStore& store, Catalogue& catalogue) {
  const auto files = distinct_files(catalogue);
  if (!files) return tl::unexpected(files.error());
  ScrubReport report;
  const auto count_bytes = [&](std::uint64_t bytes) {
    report.bytes += bytes;
    return true;
  };
  const auto note = [&](const NamedFile& file, ObjectState state) {
    ++report.objects;
    if (state != ObjectState::kIntact) report.damaged.push_back({file, state});
  };
  const auto done = scrub(store, *files, count_bytes, note);
  return done ? Expected<ScrubReport>(std::move(report)) : tl::unexpected(done.error());
}

std::string to_text(const DamagedFile& damaged) {
  return fmt::format("object {} of model {} is {}", to_hex(damaged.file.file),
                     damaged.file.model.to_string(),
                     damaged.state == ObjectState::kMissing ? "missing" : "damaged");
}

}  // namespace vitrine::server
