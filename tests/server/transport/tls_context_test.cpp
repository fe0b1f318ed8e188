// SPDX-License-Identifier: Apache-2.0
#include "server/transport/tls_context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/transport/live_tls.h"
#include "support/process/certificate.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;

class TlsContextTest : public ::testing::Test {
 protected:
  void write(const CertificateText& text) { write_certificate(text, files.certificate, files.key); }
  std::string fault() const { return TlsContext::load(files).error().message; }

  const TemporaryFolder folder;
  const TlsFiles files{folder.path() / "chain.pem", folder.path() / "key.pem"};
};

TEST_F(TlsContextTest, AcceptsACertificateAndItsKey) {
  write(make_certificate("A museum"));
  EXPECT_TRUE(TlsContext::load(files));
}

TEST_F(TlsContextTest, NamesTheFileThatCannotBeRead) {
  EXPECT_THAT(fault(), HasSubstr("cannot read " + files.certificate.string() + ": No such file"));
  write(make_certificate("A museum"));
  std::filesystem::remove(files.key);
  EXPECT_THAT(fault(), HasSubstr("cannot read " + files.key.string()));
  std::filesystem::create_directory(files.key);
  EXPECT_THAT(fault(), HasSubstr("Is a directory"));
}

TEST_F(TlsContextTest, ReportsACertificateThatIsExpiredOrNotValidYet) {
  write(make_certificate("A museum", -7200, -3600));
  EXPECT_THAT(fault(), HasSubstr("the certificate expired on "));
  write(make_certificate("A museum", 3600, 7200));
  EXPECT_THAT(fault(), HasSubstr("the certificate is valid only from "));
}

TEST_F(TlsContextTest, DetectsTheKeyOfAnotherCertificate) {
  write({make_certificate("A museum").certificate, make_certificate("Another").key});
  EXPECT_THAT(fault(), HasSubstr(files.key.string() + ": it is not the key of "));
}

TEST_F(TlsContextTest, RefusesFilesWithOtherContent) {
  write({"no certificate", "no key"});
  EXPECT_THAT(fault(), HasSubstr(files.certificate.string() + ": it is not a certificate"));
  write({make_certificate("A museum").certificate, "no key"});
  EXPECT_THAT(fault(), HasSubstr(files.key.string() + ": it is not a private key"));
}

TEST_F(TlsContextTest, ALiveCertificateFollowsItsFilesAndKeepsTheOldOneOverAFault) {
  write(make_certificate("A museum"));
  const auto live = LiveTls::open(files).value();
  const auto first = live->current();
  EXPECT_EQ(live->refresh(), false);
  const auto touch = [&](int seconds) {
    std::filesystem::last_write_time(
        files.certificate,
        std::filesystem::file_time_type::clock::now() + std::chrono::seconds(seconds));
  };
  write({"no certificate", "no key"});
  touch(1);
  EXPECT_FALSE(live->refresh());
  EXPECT_EQ(live->refresh(), false) << "each fault is reported once";
  EXPECT_EQ(live->current(), first);
  write(make_certificate("A museum"));
  touch(2);
  EXPECT_EQ(live->refresh(), true);
  EXPECT_NE(live->current(), first);
}

}  // namespace
}  // namespace vitrine::test
