// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/rights.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(RightsUrl, ComesFromIdentifiersAndFromBothSchemes) {
  const std::string by_nc_sa = "http://creativecommons.org/licenses/by-nc-sa/3.0/";
  EXPECT_EQ(rights_url("CC-BY-NC-SA-3.0"), by_nc_sa);
  EXPECT_EQ(rights_url("https://creativecommons.org/licenses/by-nc-sa/3.0/"), by_nc_sa);
  EXPECT_EQ(rights_url("https://creativecommons.org/licenses/by-nc-sa/3.0/deed.de"), by_nc_sa);
  EXPECT_EQ(rights_url("https://creativecommons.org/licenses/by-nc-sa/3.0/legalcode"), by_nc_sa);
  EXPECT_EQ(rights_url("CC0-1.0"), "http://creativecommons.org/publicdomain/zero/1.0/");
  EXPECT_EQ(rights_url("https://rightsstatements.org/vocab/InC/1.0/"),
            "http://rightsstatements.org/vocab/InC/1.0/");
}

TEST(RightsUrl, ComesFromOtherSpellings) {
  const std::string by = "http://creativecommons.org/licenses/by/4.0/";
  for (const char* licence : {"CC-BY-4.0", "cc-by-4.0", "CC BY 4.0",
                              "https://creativecommons.org/licenses/by/4.0/deed.de",
                              "https://creativecommons.org/licenses/by/4.0/deed",
                              "http://creativecommons.org/licenses/by/4.0/legalcode.en"})
    EXPECT_EQ(rights_url(licence), by) << licence;
  EXPECT_EQ(rights_url("cc0 1.0"), "http://creativecommons.org/publicdomain/zero/1.0/");
}

TEST(RightsUrl, ComesFromTheAddressesThatABrowserShows) {
  const std::string statement = "http://rightsstatements.org/vocab/InC/1.0/";
  for (const char* page : {"https://rightsstatements.org/page/InC/1.0/?language=en",
                           "https://www.rightsstatements.org/page/InC/1.0/#content",
                           "http://rightsstatements.org/vocab/InC/1.0"}) {
    EXPECT_EQ(rights_url(page), statement) << page;
    EXPECT_EQ(rights_statement_label(page), "In Copyright") << page;
  }
  const std::string by = "http://creativecommons.org/licenses/by/4.0/";
  for (const char* page : {"http://www.creativecommons.org/licenses/by/4.0/",
                           "https://creativecommons.org/licenses/by/4.0/?ref=chooser-v1",
                           "https://creativecommons.org/licenses/by/4.0"})
    EXPECT_EQ(rights_url(page), by) << page;
}

TEST(RightsUrl, HasTheJurisdictionOfTheLicence) {
  EXPECT_EQ(rights_url("CC-BY-NC-ND-3.0-DE"),
            "http://creativecommons.org/licenses/by-nc-nd/3.0/de/");
  EXPECT_EQ(rights_url("CC-BY-3.0-IGO"), "http://creativecommons.org/licenses/by/3.0/igo/");
  EXPECT_EQ(rights_url("CC-BY-SA-2.1-JP"), "http://creativecommons.org/licenses/by-sa/2.1/jp/");
  EXPECT_EQ(rights_url("https://creativecommons.org/licenses/by/3.0/de/deed.de"),
            "http://creativecommons.org/licenses/by/3.0/de/");
}

TEST(RightsUrl, AnythingElseHasNone) {
  for (const char* licence :
       {"", "MIT", "CC-BY", "CC-BY-9.0", "ask the museum", "CC-BY-3.0-Germany",
        "https://example.org/creativecommons.org/", "http://creativecommons.org.evil/",
        "http://www.creativecommons.org.evil/"})
    EXPECT_EQ(rights_url(licence), std::nullopt) << licence;
}

TEST(RightsStatements, HaveTheirLabels) {
  EXPECT_EQ(rights_statement_label("http://rightsstatements.org/vocab/InC/1.0/"), "In Copyright");
  EXPECT_EQ(rights_statement_label("https://rightsstatements.org/vocab/NKC/1.0/"),
            "No Known Copyright");
  EXPECT_EQ(rights_statement_label("http://rightsstatements.org/vocab/InC/2.0/"), "");
  EXPECT_EQ(rights_statement_label("CC0-1.0"), "");
}

}  // namespace
}  // namespace vitrine::server
