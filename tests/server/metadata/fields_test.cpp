// SPDX-License-Identifier: Apache-2.0
#include "server/metadata/fields.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(MetadataFields, TakeIdentifiersOfTheirKindOnly) {
  for (const char* good : {"", "10.5281/zenodo.1", "10.1000.10/123(a)"})
    EXPECT_FALSE(expected_text("doi", good)) << good;
  for (const char* wrong : {"https://doi.org/10.5281/x", "10.5281", "10.12/x", "10.5281/a b", "x"})
    EXPECT_TRUE(expected_text("doi", wrong)) << wrong;
  for (const char* good : {"", "https://n2t.net/ark:/12345/x", "urn:nbn:de:101:1", "hdl:20.500/1"})
    EXPECT_FALSE(expected_text("persistent_identifier", good)) << good;
  for (const char* wrong : {"Inv. 7", "7:8", "a:", "urn:with space", "://x"})
    EXPECT_TRUE(expected_text("persistent_identifier", wrong)) << wrong;
  EXPECT_FALSE(expected_text("material", "any text: at all"));
}

TEST(MetadataFields, TakeRightsStatementsOfTheListOnly) {
  for (const char* good : {"", "http://rightsstatements.org/vocab/InC/1.0/",
                           "https://rightsstatements.org/vocab/NoC-US/1.0/"})
    EXPECT_FALSE(expected_text("rights_statement", good)) << good;
  for (const char* wrong : {"InC", "In Copyright", "http://rightsstatements.org/vocab/XYZ/1.0/"})
    EXPECT_TRUE(expected_text("rights_statement", wrong)) << wrong;
}

}  // namespace
}  // namespace vitrine::server
