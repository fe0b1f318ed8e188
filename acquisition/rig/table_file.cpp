// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/table_file.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine::acquisition::rig {
namespace {

constexpr std::uint64_t kMostBytes = 100;

}  // namespace

Expected<double> read_table(const std::filesystem::path& file) {
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown)) return 0;
  const auto bytes = read_file(file, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string text(bytes->begin(), bytes->end());
  double degrees = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), degrees);
  if (error == std::errc{} && std::string_view(end) == "\n" && std::isfinite(degrees))
    return degrees;
  return fail(ErrorCode::kBadInput,
              fmt::format("{} does not contain the table's angle; remove it and restart the scans",
                          file.string()));
}

Expected<void> write_table(const std::filesystem::path& file, double degrees) {
  const std::string text = fmt::format("{}\n", degrees);
  const auto* first = reinterpret_cast<const std::uint8_t*>(text.data());
  return write_file_atomically(file, {first, text.size()});
}

}  // namespace vitrine::acquisition::rig
