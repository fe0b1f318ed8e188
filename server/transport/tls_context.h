// SPDX-License-Identifier: Apache-2.0
// The certificate and key that the server uses for connections with TLS 1.2 or 1.3.
#pragma once

#include <filesystem>
#include <memory>

#include "codec/core/expected.h"

namespace boost::asio::ssl {
class context;
}

namespace vitrine::server {

struct TlsFiles {
  // PEM file: the server's certificate, followed by the intermediate certificates up to the root.
  std::filesystem::path certificate;
  std::filesystem::path key;  // a PEM file without a passphrase

  bool operator==(const TlsFiles&) const = default;
};

// Immutable.
class TlsContext {
 public:
  // Loads the files. Fails with kIo if a file cannot be read. Fails with kBadInput if a file is not
  // a certificate or a key, if the certificate is expired or not valid yet, or if the key does not
  // belong to the certificate.
  static Expected<std::shared_ptr<const TlsContext>> load(const TlsFiles& files);

  ~TlsContext();

  // Returns the context for creating connections. Callers must not change it.
  boost::asio::ssl::context& native() const { return *context_; }

 private:
  TlsContext();

  const std::unique_ptr<boost::asio::ssl::context> context_;
};

}  // namespace vitrine::server
