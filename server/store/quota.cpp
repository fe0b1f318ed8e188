// SPDX-License-Identifier: Apache-2.0
#include "server/store/quota.h"

#include <fmt/core.h>

#include <fstream>
#include <map>

#include "codec/files/atomic_file.h"

namespace vitrine::server {
namespace {

using Sizes = std::map<Sha256, std::uint64_t>;  // size of each file in bytes, by its SHA-256

Expected<Sizes> named_files(Catalogue& catalogue) {
  const auto files = catalogue.files();
  if (!files) return tl::unexpected(files.error());
  Sizes sizes;
  for (const NamedFile& file : *files)
    sizes[file.file] = file.bytes;
  return sizes;
}

std::uint64_t sum(const Sizes& sizes) {
  std::uint64_t all = 0;
  for (const auto& [file, bytes] : sizes)
    all += bytes;
  return all;
}

constexpr const char* kQuotaFile = "quota";
constexpr const char* kReserveFile = "disk-reserve";

// Returns 0 if there is no such file.
Expected<std::uint64_t> read_number(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) return 0;
  std::uint64_t number = 0;
  if (std::ifstream(path) >> number) return number;
  return fail(ErrorCode::kIo, fmt::format("cannot read {}; check the file, or start vitrined, "
                                          "which writes it",
                                          path.string()));
}

Expected<void> write_number(const std::filesystem::path& path, std::uint64_t number) {
  if (const auto before = read_number(path); before && *before == number) return {};
  const std::string text = std::to_string(number) + "\n";
  return write_file_atomically(path,
                               {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

Expected<void> write_limits(const std::filesystem::path& folder, const DiskLimits& limits) {
  if (auto written = write_number(folder / kQuotaFile, limits.quota); !written) return written;
  return write_number(folder / kReserveFile, limits.reserve);
}

Expected<DiskLimits> read_limits(const std::filesystem::path& folder) {
  const auto quota = read_number(folder / kQuotaFile);
  if (!quota) return tl::unexpected(quota.error());
  const auto reserve = read_number(folder / kReserveFile);
  if (!reserve) return tl::unexpected(reserve.error());
  return DiskLimits{*quota, *reserve};
}

Expected<std::uint64_t> Quota::announced(const std::optional<UploadId>& spent) const {
  const auto uploads = uploads_.list();
  if (!uploads) return fail(ErrorCode::kIo, uploads.error().message);
  std::uint64_t all = 0;
  for (const Upload& upload : *uploads)
    all += upload.id == spent ? 0 : upload.length;
  return all;
}

Expected<void> Quota::check(std::uint64_t more, std::uint64_t taken) const {
  if (taken <= bytes_ && more <= bytes_ - taken) return {};
  return fail(
      ErrorCode::kLimit,
      fmt::format("{} bytes do not fit: {} of {} bytes are taken; delete models or uploads, "
                  "or raise the setting quota",
                  more, taken, bytes_));
}

Expected<void> Quota::admit(std::uint64_t bytes, const std::function<void()>& take) {
  const std::scoped_lock lock(mutex_);
  if (bytes_ != 0) {
    const auto named = named_files(catalogue_);
    if (!named) return tl::unexpected(named.error());
    const auto uploads = announced(std::nullopt);
    if (!uploads) return tl::unexpected(uploads.error());
    if (auto fits = check(bytes, sum(*named) + *uploads + reserved_); !fits) return fits;
  }
  take();
  return {};
}

Expected<Quota::Reservation> Quota::reserve(std::span<const NamedFile> files,
                                            const std::optional<UploadId>& spent) {
  if (bytes_ == 0) return Reservation();
  const std::scoped_lock lock(mutex_);
  auto named = named_files(catalogue_);
  if (!named) return tl::unexpected(named.error());
  const auto uploads = announced(spent);
  if (!uploads) return tl::unexpected(uploads.error());
  const std::uint64_t before = sum(*named);
  for (const NamedFile& file : files)
    (*named)[file.file] = file.bytes;
  const std::uint64_t more = sum(*named) - before;
  if (auto fits = check(more, before + *uploads + reserved_); !fits)
    return tl::unexpected(fits.error());
  reserved_ += more;
  return Reservation(*this, more);
}

void Quota::release(std::uint64_t bytes) {
  const std::scoped_lock lock(mutex_);
  reserved_ -= bytes;
}

}  // namespace vitrine::server
