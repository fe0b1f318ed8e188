// SPDX-License-Identifier: Apache-2.0
// The current TLS certificate. It can be replaced while the server runs; existing connections keep
// the old one.
#pragma once

#include <memory>
#include <mutex>

#include "server/transport/tls_context.h"

namespace vitrine::server {

// Thread-safe.
class LiveTls {
 public:
  // Loads the files. Fails with the errors of TlsContext::load().
  static Expected<std::shared_ptr<LiveTls>> open(const TlsFiles& files);

  std::shared_ptr<const TlsContext> current() const;

  // Reads the files again if one has changed. Returns true if the new certificate is now used,
  // false if no file has changed. If reading fails, keeps the old certificate and returns the error
  // once per change of the files.
  Expected<bool> refresh();

 private:
  using Times = std::pair<std::filesystem::file_time_type, std::filesystem::file_time_type>;
  explicit LiveTls(const TlsFiles& files) : files_(files), read_(times()) {}
  Times times() const;

  const TlsFiles files_;
  mutable std::mutex mutex_;  // guards the members below
  Times read_;                // modification times of the files that were read
  std::shared_ptr<const TlsContext> context_;
};

}  // namespace vitrine::server
