// SPDX-License-Identifier: Apache-2.0
// Makes self-signed certificates for localhost, for tests.
#pragma once

#include <filesystem>
#include <string>

namespace vitrine::test {

struct CertificateText {
  std::string certificate, key;  // both in PEM format
};

// Returns a certificate valid from `from` to `to`, in seconds from now.
CertificateText make_certificate(const std::string& organisation, long from = -60, long to = 3600);

// Writes the files that a daemon reads. Each file replaces the old one atomically.
void write_certificate(const CertificateText& text, const std::filesystem::path& certificate,
                       const std::filesystem::path& key);

}  // namespace vitrine::test
