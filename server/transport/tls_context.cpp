// SPDX-License-Identifier: Apache-2.0
#include "server/transport/tls_context.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <unistd.h>

#include <boost/asio/ssl/context.hpp>
#include <cerrno>
#include <cstring>
#include <string_view>

namespace vitrine::server {
namespace {

constexpr const char* kCiphers =
    "ECDHE-ECDSA-AES128-GCM-SHA256:ECDHE-RSA-AES128-GCM-SHA256:ECDHE-ECDSA-AES256-GCM-SHA384:"
    "ECDHE-RSA-AES256-GCM-SHA384:ECDHE-ECDSA-CHACHA20-POLY1305:ECDHE-RSA-CHACHA20-POLY1305";

Unexpected bad(const std::filesystem::path& file, std::string_view fault, std::string_view step) {
  ERR_clear_error();
  return fail(ErrorCode::kBadInput, fmt::format("{}: {}; {}", file.string(), fault, step));
}

// Checks that a file is readable, because OpenSSL's error message does not contain the reason.
Expected<void> check_readable(const std::filesystem::path& file) {
  std::error_code ignored;
  int error = std::filesystem::is_directory(file, ignored) ? EISDIR : 0;
  const int opened = error == 0 ? ::open(file.c_str(), O_RDONLY | O_CLOEXEC) : -1;
  if (opened >= 0) {
    ::close(opened);
    return {};
  }
  if (error == 0) error = errno;
  return fail(ErrorCode::kIo, fmt::format("cannot read {}: {}; check the path and its permissions",
                                          file.string(), std::strerror(error)));
}

int no_passphrase(char*, int, int, void*) {
  return 0;  // without this callback, OpenSSL would ask for a passphrase on the terminal
}

std::string text_of(const ASN1_TIME* time) {
  BIO* out = BIO_new(BIO_s_mem());
  ASN1_TIME_print(out, time);
  char* bytes = nullptr;
  const auto size = BIO_get_mem_data(out, &bytes);
  std::string text(bytes, static_cast<std::size_t>(size));
  BIO_free(out);
  return text;
}

Expected<void> check_dates(SSL_CTX* context, const std::filesystem::path& file) {
  const X509* certificate = SSL_CTX_get0_certificate(context);
  const ASN1_TIME* end = X509_get0_notAfter(certificate);
  const ASN1_TIME* start = X509_get0_notBefore(certificate);
  if (X509_cmp_current_time(end) < 0) {
    return bad(file, "the certificate expired on " + text_of(end), "renew it");
  }
  if (X509_cmp_current_time(start) > 0) {
    return bad(file, "the certificate is valid only from " + text_of(start), "check the clock");
  }
  return {};
}

// Chooses HTTP/1.1, the only protocol supported, if the client offers it (ALPN).
int choose_protocol(SSL*, const unsigned char** out, unsigned char* size, const unsigned char* in,
                    unsigned in_size, void*) {
  static constexpr unsigned char kOurs[] = "\x08http/1.1";
  unsigned char* chosen = nullptr;
  if (SSL_select_next_proto(&chosen, size, kOurs, sizeof kOurs - 1, in, in_size) !=
      OPENSSL_NPN_NEGOTIATED) {
    return SSL_TLSEXT_ERR_NOACK;
  }
  *out = chosen;
  return SSL_TLSEXT_ERR_OK;
}

void configure(SSL_CTX* context) {
  SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(context, kCiphers);
  SSL_CTX_set_options(context, SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION);
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS);  // makes idle connections free their buffers
  SSL_CTX_set_default_passwd_cb(context, no_passphrase);
  SSL_CTX_set_alpn_select_cb(context, choose_protocol, nullptr);
}

}  // namespace

TlsContext::TlsContext()
    : context_(std::make_unique<boost::asio::ssl::context>(boost::asio::ssl::context::tls_server)) {
}

TlsContext::~TlsContext() = default;

Expected<std::shared_ptr<const TlsContext>> TlsContext::load(const TlsFiles& files) {
  for (const auto& file : {files.certificate, files.key}) {
    if (auto readable = check_readable(file); !readable) return tl::unexpected(readable.error());
  }
  std::shared_ptr<TlsContext> tls(new TlsContext);
  SSL_CTX* context = tls->context_->native_handle();
  configure(context);
  if (SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) != 1) {
    return bad(files.certificate, "it is not a certificate in PEM form",
               "name a file that begins with BEGIN CERTIFICATE");
  }
  if (auto current = check_dates(context, files.certificate); !current) {
    return tl::unexpected(current.error());
  }
  if (SSL_CTX_use_PrivateKey_file(context, files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    const bool mismatch = ERR_GET_REASON(ERR_peek_error()) == X509_R_KEY_VALUES_MISMATCH;
    if (!mismatch) {
      return bad(files.key, "it is not a private key in PEM form without a passphrase",
                 "name one, or remove its passphrase");
    }
  }
  if (SSL_CTX_check_private_key(context) != 1) {
    return bad(files.key, "it is not the key of " + files.certificate.string(),
               "name the key that the certificate was made for");
  }
  return tls;
}

}  // namespace vitrine::server
