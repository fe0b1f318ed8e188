// SPDX-License-Identifier: Apache-2.0
// The profiles of a scan on disk: an append-only file of records, each with its checksum. A record
// that a crash has torn is dropped when the file is read, with all that follows it: those steps are
// scanned again. Records that are given up stay in the file, and do not count any more.
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

namespace vitrine {

inline constexpr std::uint64_t kMaxJournalBytes = std::uint64_t{4} << 30;

struct JournalContents {
  std::vector<Profile> profiles;     // of the steps 0, 1, 2, …
  std::vector<StripeCount> stripes;  // of each; of older versions' only about how many rows
  std::optional<int> stands_at;      // the step of the last note_turn()
  int given_up_at = 0;               // how many steps were done at the last give_up()
  std::size_t bytes = 0;             // of whole records; what follows is torn
};

JournalContents read_journal(std::span<const std::uint8_t> file);

class ProfileJournal {
 public:
  // Reads what is there and goes on behind it; a missing file is created. Fails with kIo.
  static Expected<ProfileJournal> open(const std::filesystem::path& path,
                                       JournalContents& contents);

  // The profile of the next step and the stripe it was found in; on disk on return. After an error
  // (kIo: a full disk) the file must be opened anew.
  Expected<void> append(const Profile& profile, const StripeCount& stripe);

  // The profiles that follow the first `kept` are to be measured again; on disk on return.
  Expected<void> give_up(int kept, int steps_done);

  // That the table stands at `step`, or soon will: a motion that has begun is completed when this
  // process has ended. Survives that, and the end of the computer together with the next profile.
  Expected<void> note_turn(int step);

 private:
  Expected<void> sync();
  Expected<void> write(std::uint32_t kind, std::vector<std::uint8_t> body);

  std::filesystem::path path_;
  FileDescriptor file_;
};

}  // namespace vitrine
