// SPDX-License-Identifier: Apache-2.0
#include "server/store/quota.h"

#include <fmt/core.h>

namespace vitrine {

Expected<void> Quota::admit(std::uint64_t more) const {
  if (bytes_ == 0) return {};
  const auto files = catalogue_.files();
  if (!files) return tl::unexpected(files.error());
  const auto uploads = uploads_.list();
  if (!uploads) return fail(ErrorCode::kIo, uploads.error().message);
  std::uint64_t used = 0;
  for (const NamedFile& file : *files)
    used += file.bytes;
  for (const Upload& upload : *uploads)
    used += upload.length;
  if (used <= bytes_ && more <= bytes_ - used) return {};
  return fail(ErrorCode::kLimit,
              fmt::format("{} bytes do not fit: {} of the quota of {} are taken; delete models or "
                          "uploads, or raise the setting quota",
                          more, used, bytes_));
}

}  // namespace vitrine
