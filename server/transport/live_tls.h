// SPDX-License-Identifier: Apache-2.0
// The certificate in force: replaced while the connections that have the old one go on.
#pragma once

#include <memory>
#include <mutex>

#include "server/transport/tls_context.h"

namespace vitrine {

// Thread-safe.
class LiveTls {
 public:
  // Fails as TlsContext::load() does.
  static Expected<std::shared_ptr<LiveTls>> open(const TlsFiles& files);

  std::shared_ptr<const TlsContext> current() const;

  // Reads the files again where one has changed since; true where what they hold is in force now.
  // A fault leaves all as it was and is told once.
  Expected<bool> refresh();

 private:
  using Times = std::pair<std::filesystem::file_time_type, std::filesystem::file_time_type>;
  explicit LiveTls(const TlsFiles& files) : files_(files), read_(times()) {}
  Times times() const;

  const TlsFiles files_;
  mutable std::mutex mutex_;  // guards what follows
  Times read_;                // when the files were written that have been read
  std::shared_ptr<const TlsContext> context_;
};

}  // namespace vitrine
