// SPDX-License-Identifier: Apache-2.0
// A scan on disk, in a folder of its own:
//   scan.json        what it is; written once, when the first checks have passed
//   profiles         the journal of its profiles
//   state.json       how it ended or why it failed; absent or "scanning" where a process was killed
//   frames/NNNNN-dark.pgm, frames/NNNNN-lit.pgm   where the pictures are kept
#pragma once

#include <filesystem>
#include <optional>

#include "acquisition/session/live_scanner.h"
#include "acquisition/session/profile_journal.h"
#include "acquisition/session/scan_request.h"
#include "acquisition/session/scan_status.h"

namespace vitrine {

struct StoredState {
  ScanState state = ScanState::kPaused;
  std::optional<Error> error;
};

class ScanFolder {
 public:
  // Makes the folder where it is missing. Fails (kState) where a scan is in it already.
  static Expected<ScanFolder> create(const std::filesystem::path& path);
  // Fails (kIo) where no scan is in it.
  static Expected<ScanFolder> open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path journal() const;

  // Nothing where the checks of the scan have not passed yet.
  Expected<std::optional<ScanRecord>> record() const;
  Expected<void> write_record(const ScanRecord& record) const;

  // As far as they are on disk.
  Expected<JournalContents> measured() const;

  StoredState state() const;
  Expected<void> write_state(const StoredState& state) const;

  // Removes the scan, but for its pictures, and the folder where nothing else is in it.
  void remove() const;

  Expected<void> write_frames(int step, const FramePair& frames) const;
  Expected<FramePair> frames(int step) const;

 private:
  explicit ScanFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path frame(int step, const char* light) const;

  std::filesystem::path path_;
};

}  // namespace vitrine
