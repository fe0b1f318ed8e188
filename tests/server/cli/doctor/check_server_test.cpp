// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "support/process/certificate.h"
#include "support/process/daemon.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<Finding> of(const std::string& check, const Findings& findings) {
  std::vector<Finding> found;
  std::ranges::copy_if(findings, std::back_inserter(found),
                       [&](const Finding& finding) { return finding.check == check; });
  return found;
}

// Returns the doctor's finding about a daemon certificate that is valid for `days` days.
Finding certificate_of(int days) {
  constexpr long kDay = 24 * 3600;
  ServedFolder folder;
  const std::string certificate = folder.path() / "chain.pem", key = folder.path() / "key.pem";
  write_certificate(make_certificate("Museum", -60, days * kDay + 3600), certificate, key);
  const Daemon daemon(folder.path(), {"--tls-certificate", certificate, "--tls-key", key});
  ::setenv("SSL_CERT_FILE", certificate.c_str(), 1);
  const auto found =
      of("certificate", check_server("https://localhost:" + std::to_string(daemon.port()), ""));
  ::unsetenv("SSL_CERT_FILE");
  return found.empty() ? Finding{} : found[0];
}

TEST(CheckServer, WarnsAboutACertificateThatExpiresSoon) {
  const Finding soon = certificate_of(10);
  EXPECT_EQ(soon.verdict, Verdict::kWarn);
  EXPECT_EQ(soon.detail, "valid for 10 days");
  EXPECT_THAT(soon.advice, HasSubstr("renew it"));
  const Finding later = certificate_of(90);
  EXPECT_EQ(later.verdict, Verdict::kOk);
  EXPECT_EQ(later.detail, "valid for 90 days");
}

class CheckScanners : public ::testing::Test {
 protected:
  std::vector<Finding> found(std::vector<std::string> options, const std::string& token) const {
    const Daemon daemon(folder.path(), std::move(options));
    return of("scanner", check_server("http://127.0.0.1:" + std::to_string(daemon.port()), token));
  }

  ServedFolder folder;
};

TEST_F(CheckScanners, ReportsAFaultOfAScannerAndTheNextStep) {
  const std::string rig = folder.path() / "rig.json";
  std::ofstream(rig) << R"({"name": "studio", "camera": {"address": "127.0.0.1"},
    "board": {"dialect": "fabscan", "vendor": "0x2341", "product": "0x0043"},
    "target": {"squares_x": 9, "squares_y": 14, "square_mm": 8, "marker_mm": 6,
               "dictionary": "DICT_4X4_100"}})";
  const auto findings = found({"--scanners", rig}, folder.token(Role::kViewer));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].verdict, Verdict::kFail);
  EXPECT_THAT(findings[0].detail, StartsWith("studio: "));
  EXPECT_NE(findings[0].advice, "");
}

TEST_F(CheckScanners, ReportsThatThereIsNoneOrThatTheTokenIsUnknown) {
  const auto none = found({}, folder.token(Role::kViewer));
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0].verdict, Verdict::kOk);
  EXPECT_EQ(none[0].detail, "no scanner is configured");
  const auto unknown = found({}, "vtr_guess");
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_EQ(unknown[0].verdict, Verdict::kFail);
  EXPECT_EQ(unknown[0].detail, "the list of scanners gets status 401");
  EXPECT_TRUE(found({}, "").empty()) << "not looked at without one";
}

}  // namespace
}  // namespace vitrine::test
