// SPDX-License-Identifier: Apache-2.0
#include "server/records/links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Preview, StandsAtTheEndOfTheHead) {
  ModelRecord model;
  model.title = "Bust";
  const std::string html =
      with_links("<head><title>x</title></head><body></body>", model, "https://museum.example");
  EXPECT_THAT(html,
              HasSubstr("<title>Bust</title><meta name=\"description\" content=\"A 3D model\">"));
  EXPECT_THAT(html, HasSubstr("<meta property=\"og:title\" content=\"Bust\">"));
  EXPECT_THAT(html, HasSubstr("\n</head><body></body>"));
  EXPECT_THAT(html, HasSubstr("href=\"https://museum.example/api/v1/oembed?url=https%3A%2F%2F"
                              "museum.example%2Fmodels%2F" +
                              model.id.to_string() + "\""));
}

TEST(Preview, ATitleIsNoMarkup) {
  ModelRecord model;
  model.title = "\"><script>alert(1)</script>&";
  const std::string html = with_links("</head>", model, "");
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("\"name\":\"\\\">\\u003cscript>alert(1)\\u003c/script>&\""));
  EXPECT_THAT(html, HasSubstr("content=\"&quot;&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;\""));
}

TEST(Preview, DescribesTheModelAsAThreeDimensionalOne) {
  ModelRecord model;
  model.title = "Bust";
  model.creator = "Polyeuktos";
  model.licence = "CC-BY-4.0";
  model.more = {{"description", "Roman copy"},
                {"subject", "orator"},
                {"doi", "10.5281/zenodo.1"},
                {"persistent_identifier", "urn:nbn:de:101:1"},
                {"identifier", "Inv. 7"}};
  const std::string html = with_links("</head>", model, "https://museum.example");
  const std::size_t start = html.find('{'), end = html.rfind('}');
  const auto model_data = nlohmann::json::parse(html.substr(start, end + 1 - start));
  const std::string page = "https://museum.example/models/" + model.id.to_string();
  EXPECT_EQ(model_data.at("@type"), "3DModel");
  EXPECT_EQ(model_data.at("name"), "Bust");
  EXPECT_EQ(model_data.at("description"), "Roman copy");
  EXPECT_EQ(model_data.at("keywords"), "orator");
  EXPECT_EQ(model_data.at("url"), page);
  EXPECT_EQ(model_data.at("creator").at("name"), "Polyeuktos");
  EXPECT_EQ(model_data.at("license"), "http://creativecommons.org/licenses/by/4.0/");
  EXPECT_EQ(model_data.at("identifier").at(0), "https://doi.org/10.5281/zenodo.1");
  EXPECT_EQ(model_data.at("identifier").at(1), "urn:nbn:de:101:1");
  EXPECT_EQ(model_data.at("identifier").at(2).at("value"), "Inv. 7");
  EXPECT_EQ(model_data.at("encoding").at("encodingFormat"), "model/gltf-binary");
  EXPECT_THAT(html, HasSubstr("<link rel=\"canonical\" href=\"" + page + "\">"));
}

TEST(Preview, AQueryTakesAnyText) {
  EXPECT_EQ(escape_query("a b&c=\xC3\xBC~"), "a%20b%26c%3D%C3%BC~");
}

std::string source_of_page() {
  std::ostringstream text;
  text << std::ifstream(VITRINE_SOURCE_DIR "/web/src/gallery/model.html").rdbuf();
  return text.str();
}

ModelRecord bust() {
  ModelRecord model;
  model.title = "Bust & base";
  model.creator = "Polyeuktos";
  model.licence = "CC-BY-4.0";
  model.more = {{"description", "A copy.\n\nOf bronze."},
                {"identifier", "Inv. 7"},
                {"material", "bronze"},
                {"collection", "Busts & heads; Bronzes"},
                {"doi", "10.5281/zenodo.1"},
                {"persistent_identifier", "https://n2t.net/ark:/12345/x"},
                {"rights_statement", "http://rightsstatements.org/vocab/NKC/1.0/"}};
  return model;
}

TEST(ModelText, StandsInThePageWithoutAScript) {
  const std::string html = with_texts(source_of_page(), bust(), "10 × 20 × 5 mm");
  EXPECT_THAT(html, HasSubstr("<h1 id=\"title\">Bust &amp; base</h1>"));
  EXPECT_THAT(html, HasSubstr("<p id=\"credit\">Polyeuktos · CC-BY-4.0</p>"));
  EXPECT_THAT(html, HasSubstr("<p>A copy.</p><p>Of bronze.</p>"));
  EXPECT_THAT(html, HasSubstr("<dt>Inventory number</dt><dd>Inv. 7</dd>"));
  EXPECT_THAT(html, HasSubstr("<dt>Material</dt><dd>bronze</dd>"));
  EXPECT_THAT(html, HasSubstr("<a href=\"/collections/Busts%20%26%20heads\">Busts &amp; heads</a>; "
                              "<a href=\"/collections/Bronzes\">Bronzes</a>"));
  EXPECT_THAT(html, HasSubstr("<dt>Dimensions</dt><dd>10 × 20 × 5 mm</dd>"));
  EXPECT_THAT(html, HasSubstr("<a href=\"https://doi.org/10.5281/zenodo.1\">10.5281/zenodo.1</a>"));
  EXPECT_THAT(html, HasSubstr("<a href=\"https://n2t.net/ark:/12345/x\">https://n2t.net/"));
  EXPECT_THAT(html, HasSubstr("<a href=\"http://rightsstatements.org/vocab/NKC/1.0/\">No Known "
                              "Copyright</a>"));
  EXPECT_THAT(html, HasSubstr("href=\"https://creativecommons.org/licenses/by/4.0/\""));
  EXPECT_THAT(html, HasSubstr("<noscript><img src=\"/api/v1/models/"));
}

TEST(ModelText, IsNoMarkup) {
  ModelRecord model = bust();
  model.title = model.creator = model.licence = model.more["description"] = "<script>x</script>";
  EXPECT_THAT(with_texts(source_of_page(), model, ""), Not(HasSubstr("<script>x")));
}

}  // namespace
}  // namespace vitrine::server
