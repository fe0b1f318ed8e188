// SPDX-License-Identifier: Apache-2.0
// Stores a scan's profiles in an append-only file of records with checksums. If a crash has left a
// record incomplete, the reader drops that record and all records after it. The scan then measures
// their steps again. Profiles that give_up() discards stay in the file but no longer count.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "acquisition/profile/judge.h"
#include "acquisition/profile/profile.h"
#include "codec/core/expected.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::acquisition {

inline constexpr std::uint64_t kMaxJournalBytes = std::uint64_t{4} << 30;

struct JournalContents {
  std::vector<Profile> profiles;  // indexed by step, from 0
  // Stripe counts; the index is the step. Records of kind kUncounted give only an approximate
  // number of rows.
  std::vector<StripeCount> stripes;
  std::optional<int> stands_at;  // the step in the last note_turn() record
  int given_up_at = 0;           // number of steps that were done at the last give_up()
  // Length of all complete records. An incomplete record may follow.
  std::size_t bytes = 0;
};

JournalContents read_journal(std::span<const std::uint8_t> file);

class ProfileJournal {
 public:
  // Reads the existing records into `contents`. Later records are appended after them. Creates a
  // missing file. Fails with kIo.
  static Expected<ProfileJournal> open(const std::filesystem::path& path,
                                       JournalContents& contents);

  // Appends the profile of the next step and the counts of its stripe. When the function returns,
  // the record is on disk. After an error (kIo, such as a full disk), the file must be reopened.
  Expected<void> append(const Profile& profile, const StripeCount& stripe);

  // Keeps the first `kept` profiles and discards all later ones, whose steps are measured again.
  // `steps_done` is the number of steps done before this call. When the function returns, the
  // record is on disk.
  Expected<void> give_up(int kept, int steps_done);

  // Records that the table stands at `step` or moves to it. (The motion completes even if this
  // process ends.) The record immediately survives the end of this process. It survives a power
  // failure only after the next profile is written.
  Expected<void> note_turn(int step);

 private:
  Expected<void> sync();
  Expected<void> write(std::uint32_t kind, std::vector<std::uint8_t> body);

  std::filesystem::path path_;
  FileDescriptor file_;
};

}  // namespace vitrine::acquisition
