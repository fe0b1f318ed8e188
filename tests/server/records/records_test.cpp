// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/records/record_format.h"
#include "server/records/xml.h"
#include "valid_xml.h"

namespace vitrine::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kOrigin = "https://museum.example";

ModelRecord ewer() {
  ModelRecord model;
  model.title = "Ewer";
  model.creator = "Workshop of Mosul; Ahmad";
  model.rights = "© Museum & friends";
  model.licence = "CC-BY-4.0";
  model.unit = "mm";
  model.accuracy = 0.1;
  for (const char* name : {"contributor", "coverage",     "date",
                           "description", "identifier",   "publisher",
                           "relation",    "source",       "subject",
                           "type",        "material",     "technique",
                           "period",      "place",        "collection",
                           "provenance",  "scan_device",  "scan_calibration",
                           "scan_date",   "scan_software"})
    model.more[name] = std::string("the ") + name;
  model.more["language"] = "de";
  model.more["subject"] = "vessels; metalwork";
  model.more["rights_statement"] = "http://rightsstatements.org/vocab/NKC/1.0/";
  model.more["persistent_identifier"] = "https://n2t.net/ark:/12345/x";
  model.more["doi"] = "10.5281/zenodo.1";
  return model;
}

const Dimensions kSize{.width = 12.5, .height = 31, .depth = 9.25, .unit = "mm"};

void expect_valid_records(const DescribedModel& model) {
  test::expect_valid(record_text(kDublinCore, model), "dublin_core.rng");
  test::expect_valid(record_text(kEdm, model), "edm.rng");
  test::expect_valid(record_text(kLido, model), "lido.rng");
}

// Returns the texts of all elements with this name.
std::vector<std::string> texts_of(const std::string& xml, const std::string& name) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(xml.c_str()));
  std::vector<std::string> texts;
  for (const auto& node : document.select_nodes(("//" + name).c_str()))
    texts.emplace_back(node.node().text().get());
  return texts;
}

TEST(Records, AreValidWhetherOrNotTheModelHasTexts) {
  expect_valid_records({ewer(), kOrigin, kSize});
  expect_valid_records({ModelRecord(), kOrigin});
  expect_valid_records({ModelRecord(), "http://localhost:8080"});
}

TEST(Records, OfHostileTextsAreValid) {
  ModelRecord model = ewer();
  const std::string hostile =
      "]]></x><!-- & \"'\x01\x0B\x7F\xFF\xC0\x80\xED\xA0\x80\xEF\xBF\xBF\xF0\x9F\x8F\xBA";
  model.title = model.creator = model.rights = model.licence = hostile;
  for (auto& [name, text] : model.more)
    text = hostile;
  for (const RecordFormat* format : kRecordFormats) {
    const std::string xml = record_text(*format, {model, kOrigin, kSize});
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(xml.c_str())) << xml;
    EXPECT_THAT(xml, HasSubstr("]]&gt;&lt;/x&gt;&lt;!-- &amp; \"'\x7F\xF0\x9F\x8F\xBA"));
    EXPECT_THAT(xml, Not(HasSubstr("\x01")));
    EXPECT_THAT(xml, Not(HasSubstr("&#")));
  }
  expect_valid_records({model, kOrigin, kSize});
}

TEST(Records, StateTheirEncoding) {
  for (const RecordFormat* format : kRecordFormats) {
    EXPECT_TRUE(record_text(*format, {ewer(), kOrigin})
                    .starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>"));
  }
}

TEST(Records, HaveOneElementForEqualValuesAndABoundedNumberOfThem) {
  ModelRecord model;
  model.creator = "A; B;A";
  EXPECT_THAT(texts_of(record_text(kDublinCore, {model, kOrigin}), "dc:creator"),
              ElementsAre("A", "B"));
  model.creator.clear();
  for (std::size_t i = 0; i < 2 * kMostValues; ++i)
    model.creator += fmt::format("{};", i);
  EXPECT_EQ(texts_of(record_text(kDublinCore, {model, kOrigin}), "dc:creator").size(), kMostValues);
}

TEST(Records, InDublinCoreStateLicenceAndRightsStatementOnce) {
  ModelRecord model;
  model.licence = "MIT";
  model.more["rights_statement"] = "https://rightsstatements.org/vocab/InC/1.0/";
  EXPECT_THAT(texts_of(record_text(kDublinCore, {model, kOrigin}), "dc:rights"),
              ElementsAre("MIT", "http://rightsstatements.org/vocab/InC/1.0/"));
  model.licence = "https://rightsstatements.org/vocab/InC/1.0/";
  EXPECT_THAT(texts_of(record_text(kDublinCore, {model, kOrigin}), "dc:rights"),
              ElementsAre("http://rightsstatements.org/vocab/InC/1.0/"));
}

TEST(Records, EscapeADoiInItsAddress) {
  ModelRecord model;
  model.more["doi"] = "10.1000/a#b?c";
  EXPECT_THAT(record_text(kDublinCore, {model, kOrigin}),
              HasSubstr(">https://doi.org/10.1000/a%23b%3Fc<"));
}

TEST(Records, InDublinCoreHaveAnElementForEachValue) {
  const std::string xml = record_text(kDublinCore, {ewer(), kOrigin, kSize});
  EXPECT_THAT(texts_of(xml, "dc:creator"), ElementsAre("Workshop of Mosul", "Ahmad"));
  EXPECT_THAT(texts_of(xml, "dc:subject"), ElementsAre("vessels", "metalwork"));
  EXPECT_THAT(
      texts_of(xml, "dc:identifier"),
      ElementsAre(kOrigin + "/models/" + ModelId().to_string(), "https://doi.org/10.5281/zenodo.1",
                  "https://n2t.net/ark:/12345/x", "the identifier"));
  EXPECT_THAT(texts_of(xml, "dc:rights"),
              ElementsAre("© Museum & friends", "http://creativecommons.org/licenses/by/4.0/",
                          "http://rightsstatements.org/vocab/NKC/1.0/"));
  EXPECT_THAT(texts_of(xml, "dc:format"),
              ElementsAre("the material", "the technique", "model/gltf-binary",
                          "12.5 × 31 × 9.25 mm (W × H × D)"));
}

TEST(Records, InEdmStateTheRightsOfAList) {
  const auto rights_in = [](const std::string& licence, const std::string& statement) {
    ModelRecord model;
    model.licence = licence;
    model.more["rights_statement"] = statement;
    return record_text(kEdm, {model, kOrigin});
  };
  const std::string statement = "http://rightsstatements.org/vocab/InC/1.0/";
  const auto stated = [](const std::string& uri) {
    return HasSubstr("<edm:rights rdf:resource=\"" + uri + "\"/>");
  };
  EXPECT_THAT(rights_in("CC0-1.0", statement),
              stated("http://creativecommons.org/publicdomain/zero/1.0/"));
  EXPECT_THAT(rights_in("MIT", statement), stated(statement));
  EXPECT_THAT(rights_in("MIT", ""), stated("http://rightsstatements.org/vocab/CNE/1.0/"));
}

TEST(Records, InEdmNameTheProvider) {
  EXPECT_THAT(texts_of(record_text(kEdm, {ewer(), kOrigin}), "edm:dataProvider"),
              ElementsAre("the publisher"));
  EXPECT_THAT(
      texts_of(record_text(kEdm, {ModelRecord(), "http://a.example:8080"}), "edm:dataProvider"),
      ElementsAre("a.example"));
}

TEST(Records, InLidoHaveMeasurements) {
  const std::string xml = record_text(kLido, {ewer(), kOrigin, kSize});
  EXPECT_THAT(texts_of(xml, "lido:measurementValue"), ElementsAre("12.5", "31", "9.25"));
  EXPECT_THAT(texts_of(xml, "lido:termMaterialsTech/lido:term"),
              ElementsAre("the material", "the technique"));
  const Dimensions tiny{.width = 1e-5, .height = 1e16, .depth = 1, .unit = "m"};
  EXPECT_THAT(texts_of(record_text(kLido, {ewer(), kOrigin, tiny}), "lido:measurementValue"),
              ElementsAre("0.00001", "10000000000000000", "1"));
}

TEST(Records, AreFoundByTheirPrefix) {
  EXPECT_EQ(find_record_format("edm"), &kEdm);
  EXPECT_EQ(find_record_format("marc21"), nullptr);
}

TEST(Host, OfAnOriginHasNoPort) {
  EXPECT_EQ(host_of("https://museum.example:8443/3d"), "museum.example");
  EXPECT_EQ(host_of("http://[::1]:8080"), "[::1]");
  EXPECT_EQ(host_of("http://[::1]"), "[::1]");
  EXPECT_EQ(host_of(""), "localhost");
}

}  // namespace
}  // namespace vitrine::server
