// SPDX-License-Identifier: Apache-2.0
#include "support/process/certificate.h"
#include "support/product_names.h"

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <fstream>
#include <functional>

namespace vitrine::test {
namespace {

std::string pem(const std::function<void(BIO*)>& write) {
  BIO* out = BIO_new(BIO_s_mem());
  write(out);
  char* bytes = nullptr;
  const auto size = BIO_get_mem_data(out, &bytes);
  std::string text(bytes, static_cast<std::size_t>(size));
  BIO_free(out);
  return text;
}

void name(X509* certificate, const char* field, const std::string& value) {
  X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate), field, MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(value.c_str()), -1, -1, 0);
}

void replace(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream(part) << text;
  std::filesystem::rename(part, file);
}

}  // namespace

CertificateText make_certificate(const std::string& organisation, long from, long to) {
  EVP_PKEY* key = EVP_EC_gen("P-256");
  X509* certificate = X509_new();
  ASN1_INTEGER_set(X509_get_serialNumber(certificate), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate), from);
  X509_gmtime_adj(X509_getm_notAfter(certificate), to);
  name(certificate, "CN", "localhost");
  name(certificate, "O", organisation);
  X509_set_issuer_name(certificate, X509_get_subject_name(certificate));
  X509_set_pubkey(certificate, key);
  X509_sign(certificate, key, EVP_sha256());
  CertificateText text{
      pem([&](BIO* out) { PEM_write_bio_X509(out, certificate); }),
      pem([&](BIO* out) { PEM_write_bio_PrivateKey(out, key, nullptr, nullptr, 0, nullptr, {}); })};
  X509_free(certificate);
  EVP_PKEY_free(key);
  return text;
}

void write_certificate(const CertificateText& text, const std::filesystem::path& certificate,
                       const std::filesystem::path& key) {
  replace(key, text.key);
  replace(certificate, text.certificate);
}

}  // namespace vitrine::test
