// SPDX-License-Identifier: Apache-2.0
// A scan on disk, in a folder of its own:
//   scan.json        the scan's record; written once, after the first checks have passed
//   profiles         the journal of its profiles
//   state.json       how it ended or why it failed; absent or "scanning" if a process was killed
//   frames/NNNNN-dark.pgm, frames/NNNNN-lit.pgm   the pictures, if they are kept
#pragma once

#include <filesystem>
#include <optional>

#include "acquisition/session/live_scanner.h"
#include "acquisition/session/profile_journal.h"
#include "acquisition/session/scan_request.h"
#include "acquisition/session/scan_status.h"

namespace vitrine::acquisition {

struct StoredState {
  ScanState state = ScanState::kPaused;
  std::optional<Error> error;
};

class ScanFolder {
 public:
  // Creates the folder if it is missing. Fails with kState if it already holds a scan.
  static Expected<ScanFolder> create(const std::filesystem::path& path);
  // Opens the folder of a scan. Fails with kIo if the folder holds no scan.
  static Expected<ScanFolder> open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path journal() const;

  // Returns the scan's record, or nullopt if the scan's first checks have not passed yet.
  Expected<std::optional<ScanRecord>> record() const;
  Expected<void> write_record(const ScanRecord& record) const;

  // Returns the profiles that are on disk.
  Expected<JournalContents> measured() const;

  StoredState state() const;
  Expected<void> write_state(const StoredState& state) const;

  // Removes the scan, but not its pictures. Then removes the folder if it is empty.
  void remove() const;

  Expected<void> write_frames(int step, const FramePair& frames) const;
  Expected<FramePair> frames(int step) const;

 private:
  explicit ScanFolder(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path frame(int step, const char* light) const;

  std::filesystem::path path_;
};

}  // namespace vitrine::acquisition
