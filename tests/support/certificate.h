// SPDX-License-Identifier: Apache-2.0
// Certificates for tests: signed by themselves, for localhost.
#pragma once

#include <filesystem>
#include <string>

namespace vitrine::test {

struct CertificateText {
  std::string certificate, key;  // PEM
};

// In force from `from` to `to`, seconds from now.
CertificateText make_certificate(const std::string& organisation, long from = -60, long to = 3600);

// As the files that a daemon reads; each appears whole.
void write_certificate(const CertificateText& text, const std::filesystem::path& certificate,
                       const std::filesystem::path& key);

}  // namespace vitrine::test
