// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/profile_journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "codec/core/byte_cursor.h"
#include "codec/core/sha256.h"
#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine::acquisition {
namespace {

// The kinds of records. kUncounted is a profile in an older format without stripe counts, which can
// still be read. A record consists of its kind, the size of its body, the body, and a checksum: the
// first eight bytes of the SHA-256 of the preceding parts.
constexpr std::uint32_t kUncounted = 1, kTurn = 2, kProfile = 3, kGivenUp = 4;
constexpr std::size_t kHeadBytes = 8, kChecksumBytes = 8, kPointBytes = 3 * 8 + 4 + 1;
constexpr std::size_t kThetaBytes = 8, kCountBytes = 5 * 8;

void put_checksum(std::vector<std::uint8_t>& record) {
  const Sha256 digest = sha256(record);
  record.insert(record.end(), digest.begin(), digest.begin() + kChecksumBytes);
}

bool has_checksum(std::span<const std::uint8_t> record) {
  const auto content = record.first(record.size() - kChecksumBytes);
  const Sha256 digest = sha256(content);
  return std::equal(record.end() - kChecksumBytes, record.end(), digest.begin());
}

std::vector<std::uint8_t> body_of(const Profile& profile, const StripeCount& stripe) {
  ByteWriter out;
  for (const std::uint64_t count :
       {stripe.rows, stripe.saturated, stripe.doubled, stripe.pixels, stripe.full})
    out.u64(count);
  out.f64(profile.theta);
  for (const ProfilePoint& point : profile.points) {
    out.f64(point.at.rho), out.f64(point.at.lateral), out.f64(point.at.z);
    out.u32(static_cast<std::uint32_t>(point.row));
    out.u8(point.flags);
  }
  return out.take();
}

StripeCount stripe_of(ByteReader& in) {
  return {.frames = 1,
          .rows = in.u64(),
          .saturated = in.u64(),
          .doubled = in.u64(),
          .pixels = in.u64(),
          .full = in.u64()};
}

Profile profile_of(ByteReader& in) {
  Profile profile{.theta = in.f64(), .points = {}};
  profile.points.resize(in.left() / kPointBytes);
  for (ProfilePoint& point : profile.points) {
    point.at.rho = in.f64(), point.at.lateral = in.f64(), point.at.z = in.f64();
    point.row = static_cast<int>(in.u32());
    point.flags = in.u8();
  }
  return profile;
}

bool is_profile(std::uint32_t kind, std::size_t body) {
  const std::size_t before = kThetaBytes + (kind == kProfile ? kCountBytes : 0);
  return (kind == kProfile || kind == kUncounted) && body >= before &&
         (body - before) % kPointBytes == 0;
}

void add_profile(JournalContents& contents, std::uint32_t kind,
                 std::span<const std::uint8_t> body) {
  ByteReader in(body);
  StripeCount stripe{.frames = 1};
  if (kind == kProfile) stripe = stripe_of(in);
  contents.profiles.push_back(profile_of(in));
  if (kind == kUncounted) stripe.rows = contents.profiles.back().points.size();
  contents.stripes.push_back(stripe);
}

void give_up(JournalContents& contents, std::span<const std::uint8_t> body) {
  ByteReader in(body);
  const std::size_t kept = std::min<std::size_t>(in.u32(), contents.profiles.size());
  contents.profiles.resize(kept);
  contents.stripes.resize(kept);
  contents.given_up_at = static_cast<int>(in.u32());
}

// Returns the body of the next record. Returns an empty body at the end of the file or if the
// record is incomplete.
std::span<const std::uint8_t> next_record(std::span<const std::uint8_t> rest, std::uint32_t& kind) {
  ByteReader in(rest);
  kind = in.u32();
  const std::uint32_t size = in.u32();
  const auto body = in.bytes(size);
  in.bytes(kChecksumBytes);
  if (!in.is_ok() || !has_checksum(rest.first(in.position()))) return {};
  return body;
}

Unexpected refused(const char* what, const std::filesystem::path& path, int error) {
  return fail(ErrorCode::kIo, fmt::format("cannot {} {}: {}; {}", what, path.string(),
                                          std::strerror(error), next_step(error)));
}

}  // namespace

JournalContents read_journal(std::span<const std::uint8_t> file) {
  JournalContents contents;
  std::uint32_t kind = 0;
  for (;;) {
    const auto body = next_record(file.subspan(contents.bytes), kind);
    if (is_profile(kind, body.size())) {
      add_profile(contents, kind, body);
    } else if (kind == kTurn && body.size() == 4) {
      contents.stands_at = static_cast<int>(ByteReader(body).u32());
    } else if (kind == kGivenUp && body.size() == 8) {
      give_up(contents, body);
    } else {
      return contents;
    }
    contents.bytes += kHeadBytes + body.size() + kChecksumBytes;
  }
}

Expected<ProfileJournal> ProfileJournal::open(const std::filesystem::path& path,
                                              JournalContents& contents) {
  ProfileJournal journal;
  journal.path_ = path;
  journal.file_ =
      FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (!journal.file_) return refused("open", path, errno);
  const auto bytes = read_file(path, kMaxJournalBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  contents = read_journal(*bytes);
  if (contents.bytes < bytes->size() &&
      ::ftruncate(journal.file_.get(), static_cast<off_t>(contents.bytes)) != 0)
    return refused("repair", path, errno);
  if (auto synced = sync_folder(folder_of(path)); !synced) return tl::unexpected(synced.error());
  return journal;
}

Expected<void> ProfileJournal::append(const Profile& profile, const StripeCount& stripe) {
  return write(kProfile, body_of(profile, stripe)).and_then([this] { return sync(); });
}

Expected<void> ProfileJournal::give_up(int kept, int steps_done) {
  ByteWriter body;
  body.u32(static_cast<std::uint32_t>(kept));
  body.u32(static_cast<std::uint32_t>(steps_done));
  return write(kGivenUp, body.take()).and_then([this] { return sync(); });
}

Expected<void> ProfileJournal::note_turn(int step) {
  ByteWriter body;
  body.u32(static_cast<std::uint32_t>(step));
  return write(kTurn, body.take());
}

Expected<void> ProfileJournal::sync() {
  if (::fdatasync(file_.get()) != 0) return refused("write", path_, errno);
  return {};
}

Expected<void> ProfileJournal::write(std::uint32_t kind, std::vector<std::uint8_t> body) {
  ByteWriter out;
  out.u32(kind);
  out.u32(static_cast<std::uint32_t>(body.size()));
  out.bytes(body);
  std::vector<std::uint8_t> record = out.take();
  put_checksum(record);
  // Writes the record in one call. If the disk is full, the call may write only a part, which later
  // counts as an incomplete record.
  ssize_t n = 0;
  do {
    n = ::write(file_.get(), record.data(), record.size());
  } while (n < 0 && errno == EINTR);
  if (n == static_cast<ssize_t>(record.size())) return {};
  return refused("write", path_, n < 0 ? errno : ENOSPC);
}

}  // namespace vitrine::acquisition
