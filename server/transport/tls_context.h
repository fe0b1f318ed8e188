// SPDX-License-Identifier: Apache-2.0
// The certificate and the key that the server shows those who connect with TLS 1.2 or 1.3.
#pragma once

#include <filesystem>
#include <memory>

#include "codec/core/expected.h"

namespace boost::asio::ssl {
class context;
}

namespace vitrine {

struct TlsFiles {
  std::filesystem::path certificate;  // PEM: the server's own, then those that lead to the root
  std::filesystem::path key;          // PEM, without a passphrase

  bool operator==(const TlsFiles&) const = default;
};

// Immutable.
class TlsContext {
 public:
  // Fails where a file cannot be read (kIo), is not what it should be, is out of its time, or the
  // key is not the certificate's (kBadInput).
  static Expected<std::shared_ptr<const TlsContext>> load(const TlsFiles& files);

  ~TlsContext();

  // Connections are made from it; nothing of it is changed.
  boost::asio::ssl::context& native() const { return *context_; }

 private:
  TlsContext();

  const std::unique_ptr<boost::asio::ssl::context> context_;
};

}  // namespace vitrine
