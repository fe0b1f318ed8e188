// SPDX-License-Identifier: Apache-2.0
// An HttpClient that speaks TLS, and does not ask who signed the certificate.
#pragma once

#include "support/http_client.h"

struct ssl_st;

namespace vitrine::test {

class TlsClient final : public HttpClient {
 public:
  // Throws where the handshake fails, at most with that version of TLS: 2 for 1.2, 3 for 1.3.
  explicit TlsClient(std::uint16_t port, int minor = 3);

  std::string organisation() const;  // whose certificate the server has shown
  bool was_told_goodbye() const;     // by TLS itself: nothing has been cut off

 private:
  ssize_t read_some(char* bytes, std::size_t size) override;
  ssize_t write_some(const char* bytes, std::size_t size) override;

  std::shared_ptr<ssl_st> tls_;
};

}  // namespace vitrine::test
