// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/scan_folder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "acquisition/session/json_members.h"
#include "acquisition/session/pgm.h"
#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine::acquisition {
namespace {

namespace fs = std::filesystem;

constexpr const char *kRecordName = "scan.json", *kJournalName = "profiles",
                     *kStateName = "state.json";
constexpr std::uint64_t kMaxFrameBytes = std::uint64_t{1} << 30;

Expected<void> make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directory(path, error);
  if (!error) return sync_folder(folder_of(path));
  return fail(ErrorCode::kIo, fmt::format("cannot make the folder {}: {}; {}", path.string(),
                                          error.message(), next_step(error.value())));
}

Expected<std::string> read_text(const fs::path& path) {
  const auto bytes = read_file(path, kMaxJsonBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return std::string(bytes->begin(), bytes->end());
}

Expected<void> write_text(const fs::path& path, const std::string& text) {
  return write_file_atomically(
      path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

Expected<Frame> read_frame(const fs::path& path) {
  const auto bytes = read_file(path, kMaxFrameBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return from_pgm(*bytes).map_error([&](const Error& error) {
    return Error{error.code, fmt::format("{} {}", path.string(), error.message)};
  });
}

// Returns the error that the folder already holds another scan.
Error in_the_way(const ScanFolder& there) {
  const ScanState state = there.state().state;
  const bool has_ended = state == ScanState::kDone || state == ScanState::kCancelled;
  return {
      ErrorCode::kState,
      has_ended
          ? fmt::format("{} contains a scan that is {}; give another name, or reprocess that scan",
                        there.path().string(), name_of(state))
          : fmt::format("{} already contains a scan; resume it or remove the folder",
                        there.path().string())};
}

}  // namespace

Expected<ScanFolder> ScanFolder::create(const fs::path& path) {
  ScanFolder folder(path);
  std::error_code ignored;  // make_folder() below reports the error
  if (fs::exists(folder.path_ / kRecordName, ignored)) return tl::unexpected(in_the_way(folder));
  if (auto made = make_folder(path); !made) return tl::unexpected(made.error());
  return folder;
}

Expected<ScanFolder> ScanFolder::open(const fs::path& path) {
  std::error_code ignored;
  ScanFolder folder(path);
  if (fs::exists(folder.path_ / kRecordName, ignored)) return folder;
  return fail(ErrorCode::kIo,
              fmt::format("there is no scan in {}; start a new one", path.string()));
}

fs::path ScanFolder::journal() const {
  return path_ / kJournalName;
}

Expected<std::optional<ScanRecord>> ScanFolder::record() const {
  const fs::path file = path_ / kRecordName;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  const auto text = read_text(file);
  if (!text) return tl::unexpected(text.error());
  auto record = scan_record_of(*text, file.string());
  if (!record) return tl::unexpected(record.error());
  return std::optional(std::move(*record));
}

Expected<void> ScanFolder::write_record(const ScanRecord& record) const {
  return write_text(path_ / kRecordName, to_json_text(record));
}

Expected<JournalContents> ScanFolder::measured() const {
  const auto bytes = read_file(journal(), kMaxJournalBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return read_journal(*bytes);
}

void ScanFolder::remove() const {
  std::error_code ignored;  // a file that cannot be removed is harmless
  for (const char* name : {kRecordName, kJournalName, kStateName})
    fs::remove(path_ / name, ignored);
  fs::remove(path_, ignored);
}

StoredState ScanFolder::state() const {
  // A scan whose state cannot be read counts as interrupted, so it can be resumed.
  const auto text = read_text(path_ / kStateName);
  const auto object = text ? parse_json_object(*text, "state.json")
                           : Expected<nlohmann::json>(tl::unexpected(text.error()));
  if (!object) return {};
  JsonMembers members(*object, "state.json", {"state", "error"});
  const auto state = state_of(members.text("state"));
  if (!state) return {};
  if (*state == ScanState::kFailed)
    return {*state, Error{ErrorCode::kState, members.text("error", "it failed; resume it")}};
  if (*state == ScanState::kDone || *state == ScanState::kCancelled) return {*state, std::nullopt};
  return {};
}

Expected<void> ScanFolder::write_state(const StoredState& state) const {
  nlohmann::json object = {{"state", name_of(state.state)}};
  if (state.error) object["error"] = state.error->message;
  return write_text(path_ / kStateName, object.dump() + "\n");
}

fs::path ScanFolder::frame(int step, const char* light) const {
  return path_ / "frames" / fmt::format("{:05}-{}.pgm", step, light);
}

Expected<void> ScanFolder::write_frames(int step, const FramePair& frames) const {
  if (auto made = make_folder(path_ / "frames"); !made) return made;
  if (auto dark = write_file_atomically(frame(step, "dark"), to_pgm(frames.dark)); !dark)
    return dark;
  return write_file_atomically(frame(step, "lit"), to_pgm(frames.lit));
}

Expected<FramePair> ScanFolder::frames(int step) const {
  auto dark = read_frame(frame(step, "dark")), lit = read_frame(frame(step, "lit"));
  if (!dark) return tl::unexpected(dark.error());
  if (!lit) return tl::unexpected(lit.error());
  return FramePair{std::move(*dark), std::move(*lit)};
}

}  // namespace vitrine::acquisition
