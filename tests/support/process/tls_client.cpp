// SPDX-License-Identifier: Apache-2.0
#include "support/process/tls_client.h"
#include "support/product_names.h"

#include <openssl/ssl.h>

#include <stdexcept>

namespace vitrine::test {

TlsClient::TlsClient(std::uint16_t port, int minor) : HttpClient(port) {
  SSL_CTX* context = SSL_CTX_new(TLS_client_method());
  SSL_CTX_set_min_proto_version(context, TLS1_VERSION);
  SSL_CTX_set_max_proto_version(context, TLS1_VERSION + minor);
  tls_ = {SSL_new(context), SSL_free};
  SSL_CTX_free(context);
  SSL_set_fd(tls_.get(), socket());
  if (SSL_connect(tls_.get()) != 1) throw std::runtime_error("no TLS handshake");
}

std::string TlsClient::organisation() const {
  char text[64] = "";
  X509_NAME_get_text_by_NID(X509_get_subject_name(SSL_get0_peer_certificate(tls_.get())),
                            NID_organizationName, text, sizeof text);
  return text;
}

bool TlsClient::was_told_goodbye() const {
  return (SSL_get_shutdown(tls_.get()) & SSL_RECEIVED_SHUTDOWN) != 0;
}

ssize_t TlsClient::read_some(char* bytes, std::size_t size) {
  return SSL_read(tls_.get(), bytes, static_cast<int>(size));
}

ssize_t TlsClient::write_some(const char* bytes, std::size_t size) {
  return SSL_write(tls_.get(), bytes, static_cast<int>(size));
}

}  // namespace vitrine::test
