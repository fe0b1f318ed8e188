// SPDX-License-Identifier: Apache-2.0
// An HttpClient that uses TLS and does not verify the certificate.
#pragma once

#include "support/process/http_client.h"
#include "support/product_names.h"

struct ssl_st;

namespace vitrine::test {

class TlsClient final : public HttpClient {
 public:
  // `minor` gives the highest version of TLS to use: 2 for TLS 1.2, 3 for TLS 1.3. Throws if the
  // handshake fails.
  explicit TlsClient(std::uint16_t port, int minor = 3);

  std::string organisation() const;  // the organisation in the server's certificate
  bool was_told_goodbye() const;     // whether the server sent close_notify, so nothing was cut off

 private:
  ssize_t read_some(char* bytes, std::size_t size) override;
  ssize_t write_some(const char* bytes, std::size_t size) override;

  std::shared_ptr<ssl_st> tls_;
};

}  // namespace vitrine::test
