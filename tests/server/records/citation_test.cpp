// SPDX-License-Identifier: Apache-2.0
#include "server/records/citation.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

ModelRecord krater(const std::string& creator) {
  ModelRecord model;
  model.title = "Krater";
  model.creator = creator;
  model.created = 1'764'489'600'000;  // in 2025
  model.more = {{"date", "c. 450 BC"}, {"publisher", "Glyptothek"}, {"doi", "10.5281/zenodo.1"}};
  return model;
}

Citations cited(const ModelRecord& model) {
  return citations_of({model, "https://museum.example"});
}

TEST(Citation, HasThreeStyles) {
  const Citations all = cited(krater("Euphronios"));
  EXPECT_EQ(all.apa,
            "Euphronios. (c. 450 BC). Krater [3D model]. Glyptothek. "
            "https://doi.org/10.5281/zenodo.1");
  EXPECT_EQ(all.chicago,
            "Euphronios. Krater. c. 450 BC. 3D model. Glyptothek. "
            "https://doi.org/10.5281/zenodo.1.");
  EXPECT_EQ(all.mla,
            "Euphronios. Krater. c. 450 BC, Glyptothek, https://doi.org/10.5281/zenodo.1. "
            "3D model.");
}

TEST(Citation, NamesSeveralCreatorsAsEachStyleDoes) {
  const Citations two = cited(krater("A; B"));
  EXPECT_TRUE(two.apa.starts_with("A, & B. (c. "));
  EXPECT_TRUE(two.chicago.starts_with("A and B. Krater. "));
  EXPECT_TRUE(two.mla.starts_with("A, and B. Krater. "));
  const Citations three = cited(krater("A;B ; C"));
  EXPECT_TRUE(three.apa.starts_with("A, B, & C. (c. "));
  EXPECT_TRUE(three.chicago.starts_with("A, B, and C. Krater. "));
  EXPECT_TRUE(three.mla.starts_with("A, et al. Krater. "));
}

TEST(Citation, OfAModelWithoutTextsHasItsYearAndItsPage) {
  ModelRecord model;
  model.title = "Who am I?";
  model.created = 1'764'489'600'000;
  const std::string page = "https://museum.example/models/" + model.id.to_string();
  const Citations all = cited(model);
  EXPECT_EQ(all.apa, "Who am I? [3D model]. (2025). museum.example. " + page);
  EXPECT_EQ(all.chicago, "Who am I? 2025. 3D model. museum.example. " + page + ".");
  EXPECT_EQ(all.mla, "Who am I? 2025, museum.example, " + page + ". 3D model.");
}

TEST(Citation, HasThePersistentIdentifierIfThereIsNoDoiAndBrowsersCanOpenIt) {
  ModelRecord model = krater("");
  model.more.erase("doi");
  model.more["persistent_identifier"] = "https://n2t.net/ark:/12345/x";
  EXPECT_TRUE(cited(model).apa.ends_with(" https://n2t.net/ark:/12345/x"));
  model.more["persistent_identifier"] = "urn:nbn:de:101:1";
  EXPECT_TRUE(cited(model).apa.ends_with("/models/" + model.id.to_string()));
}

}  // namespace
}  // namespace vitrine::server
