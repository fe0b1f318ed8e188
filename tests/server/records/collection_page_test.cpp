// SPDX-License-Identifier: Apache-2.0
#include "server/records/collection_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string gallery() {
  std::ostringstream text;
  text << std::ifstream(VITRINE_SOURCE_DIR "/web/src/gallery/index.html").rdbuf();
  return text.str();
}

TEST(CollectionPage, ListsItsModelsWithoutAScript) {
  ModelRecord model;
  model.id = ModelId::generate();
  model.title = "Krater <1>";
  const std::string html =
      with_collection(gallery(), "Vases & jugs", std::span(&model, 1), "https://museum.example");
  EXPECT_THAT(html, HasSubstr("<title>Vases &amp; jugs</title>"));
  EXPECT_THAT(html, HasSubstr("<h1 id=\"title\">Vases &amp; jugs</h1>"));
  EXPECT_THAT(html, HasSubstr("<ul id=\"models\"><li><a href=\"/models/" + model.id.to_string()));
  EXPECT_THAT(html, HasSubstr("<h2>Krater &lt;1&gt;</h2>"));
  EXPECT_THAT(html, HasSubstr("<link rel=\"canonical\" "
                              "href=\"https://museum.example/collections/Vases%20%26%20jugs\">"));
  EXPECT_THAT(html,
              HasSubstr("href=\"https://museum.example/api/v1/iiif/collection.json?collection="
                        "Vases%20%26%20jugs\">"));
}

TEST(CollectionPage, TakesNoMarkupFromTexts) {
  ModelRecord model;
  model.title = model.creator = "<script>x</script>";
  EXPECT_THAT(with_collection(gallery(), model.title, std::span(&model, 1), ""),
              Not(HasSubstr("<script>x")));
}

}  // namespace
}  // namespace vitrine::server
