// SPDX-License-Identifier: Apache-2.0
// Tests the responses of OAI-PMH on a catalogue in SQLite.
#include "server/records/oai.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <pugixml.hpp>
#include <set>

#include "server/catalogue/sqlite.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/messages/timestamp.h"
#include "server/records/oai_request.h"
#include "server/records/oai_set.h"
#include "support/temporary_folder.h"
#include "valid_xml.h"

namespace vitrine::server {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class Oai : public testing::Test {
 protected:
  ModelId add(const std::string& title, const std::string& collection = "",
              ModelState state = ModelState::kPublished) {
    ModelRecord model{.id = ModelId::generate(), .state = state};
    model.title = title;
    model.licence = "CC0-1.0";
    if (!collection.empty()) model.more["collection"] = collection;
    EXPECT_TRUE(catalogue_->add(model, {}));
    return model.id;
  }

  // Sets the time of the last change, in seconds since 1970, of all models for which an earlier
  // call has not set it. `seconds` must be at most 1,500,000,000.
  void changed_at(std::int64_t seconds) {
    sqlite::SqliteHandle(file_).run(
        fmt::format("UPDATE model_index SET changed = {} WHERE changed > 1500000000", seconds)
            .c_str());
  }

  std::string unchecked(const std::string& query) {
    return answer_oai(*Query::parse(query), site_, *catalogue_).value();
  }

  // Returns the response, which must be valid.
  std::string ask(const std::string& query) {
    const std::string text = unchecked(query);
    test::expect_valid(text, "oai.rng");
    return text;
  }

  std::vector<std::string> ask_for(const std::string& query, const std::string& path) {
    return values_in_xml(ask(query), path);
  }

  // Returns the values of all elements or attributes at this XPath.
  static std::vector<std::string> values_in_xml(const std::string& xml, const std::string& path) {
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(xml.c_str()));
    std::vector<std::string> values;
    for (const auto& found : document.select_nodes(path.c_str()))
      values.emplace_back(found.attribute() ? found.attribute().value()
                                            : found.node().text().get());
    return values;
  }

  std::string error_of(const std::string& query) {
    const auto codes = ask_for(query, "//error/@code");
    return codes.size() == 1 ? codes[0] : fmt::format("{} errors", codes.size());
  }

  static std::string id_of(const ModelId& model) {
    return "oai:museum.example:" + model.to_string();
  }

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "catalogue.sqlite";
  const std::unique_ptr<Catalogue> catalogue_ = open_sqlite_catalogue(file_).value();
  OaiSite site_{.origin = "https://museum.example", .now = 1'764'489'600};
};

TEST_F(Oai, IdentifiesTheServer) {
  EXPECT_THAT(ask_for("verb=Identify", "//earliestDatestamp"), ElementsAre("1970-01-01T00:00:00Z"));
  add("Bust");
  changed_at(1'000'000'000);
  const std::string text = ask("verb=Identify");

  EXPECT_THAT(text, HasSubstr("<baseURL>https://museum.example/api/v1/oai</baseURL>"));
  EXPECT_THAT(text, HasSubstr("<earliestDatestamp>2001-09-09T01:46:40Z</earliestDatestamp>"));
  EXPECT_THAT(text, HasSubstr("<adminEmail>webmaster@museum.example</adminEmail>"));
  site_.contact = "3d@museum.example";
  EXPECT_THAT(ask_for("verb=Identify", "//adminEmail"), ElementsAre("3d@museum.example"));
  site_ = {.origin = "http://localhost:8080"};
  EXPECT_THAT(ask_for("verb=Identify", "//adminEmail"), ElementsAre("webmaster@localhost.invalid"));
}

TEST_F(Oai, StatesATimeShortlyBeforeTheListWasRead) {
  add("Bust");
  const auto now = std::chrono::duration_cast<std::chrono::seconds>(
                       std::chrono::system_clock::now().time_since_epoch())
                       .count();
  const auto dates = ask_for("verb=ListRecords&metadataPrefix=oai_dc", "//responseDate");
  const auto date = parse_utc_time(dates.at(0));
  ASSERT_TRUE(date);
  EXPECT_LT(*date, now);
  EXPECT_GT(*date, now - 60);
  EXPECT_THAT(ask_for("verb=ListMetadataFormats", "//responseDate"),
              ElementsAre("2025-11-30T08:00:00Z"));
}

TEST_F(Oai, ListsItsFormats) {
  EXPECT_THAT(ask_for("verb=ListMetadataFormats", "//metadataPrefix"),
              ElementsAre("oai_dc", "edm", "lido"));
  const ModelId bust = add("Bust");
  EXPECT_THAT(ask_for("verb=ListMetadataFormats&identifier=" + id_of(bust), "//metadataPrefix"),
              ElementsAre("oai_dc", "edm", "lido"));
}

TEST_F(Oai, GivesARecordInEachFormat) {
  const ModelId bust = add("Bust", "Busts & heads");
  const auto get = [&](const std::string& prefix) {
    return ask("verb=GetRecord&metadataPrefix=" + prefix + "&identifier=" + id_of(bust));
  };
  EXPECT_THAT(get("oai_dc"), HasSubstr("<dc:title>Bust</dc:title>"));
  EXPECT_THAT(get("edm"), HasSubstr("<edm:type>3D</edm:type>"));
  EXPECT_THAT(get("lido"), HasSubstr("<lido:appellationValue>Bust</lido:appellationValue>"));
  EXPECT_THAT(get("lido"), HasSubstr("<setSpec>Busts_20_26_20heads</setSpec>"));
}

TEST_F(Oai, KnowsNoDraftAndNoRemovedModel) {
  const ModelId draft = add("Secret", "Hidden", ModelState::kDraft), gone = add("Gone");
  ASSERT_TRUE(catalogue_->remove(gone, std::nullopt));
  for (const ModelId& id : {draft, gone}) {
    EXPECT_EQ(error_of("verb=GetRecord&metadataPrefix=edm&identifier=" + id_of(id)),
              "idDoesNotExist");
    EXPECT_EQ(error_of("verb=ListMetadataFormats&identifier=" + id_of(id)), "idDoesNotExist");
  }
  EXPECT_EQ(error_of("verb=ListRecords&metadataPrefix=oai_dc"), "noRecordsMatch");
  EXPECT_EQ(error_of("verb=ListSets"), "noSetHierarchy");
}

TEST_F(Oai, ListsRecordsOfAPeriod) {
  add("Old");
  changed_at(1'000'000'000);  // 2001-09-09T01:46:40Z
  add("Newer");
  changed_at(1'000'000'001);
  const auto titles = [&](const std::string& range) {
    return ask_for("verb=ListRecords&metadataPrefix=oai_dc" + range, "//dc:title");
  };
  EXPECT_THAT(titles(""), ElementsAre("Old", "Newer"));
  EXPECT_THAT(titles("&until=2001-09-09T01:46:40Z"), ElementsAre("Old"));
  EXPECT_THAT(titles("&from=2001-09-09T01:46:41Z"), ElementsAre("Newer"));
  EXPECT_THAT(titles("&from=2001-09-09&until=2001-09-09"), ElementsAre("Old", "Newer"));
  EXPECT_THAT(titles("&from=1900-01-01"), ElementsAre("Old", "Newer"));
  for (const char* range : {"&from=2001-09-10", "&until=1969-12-31"})
    EXPECT_EQ(error_of(std::string("verb=ListRecords&metadataPrefix=oai_dc") + range),
              "noRecordsMatch");
}

TEST_F(Oai, ListsTheModelsOfASet) {
  const ModelId vase = add("Vase", "Vases; Äginetica");
  add("Bust");
  EXPECT_THAT(ask_for("verb=ListSets", "//setSpec"), ElementsAre("Vases", "_C3_84ginetica"));
  EXPECT_THAT(ask_for("verb=ListSets", "//setName"), ElementsAre("Vases", "Äginetica"));
  const std::string list = "verb=ListIdentifiers&metadataPrefix=lido&set=";
  EXPECT_THAT(ask_for(list + "_C3_84ginetica", "//identifier"), ElementsAre(id_of(vase)));
  EXPECT_EQ(error_of(list + "Other"), "noRecordsMatch");
  EXPECT_EQ(error_of(list + "_c3"), "badArgument");
}

// A fixture for lists of several pages. all_pages() follows the resumption tokens of a list, and
// returns the values at the XPath `path` on all pages.
class OaiPages : public Oai {
 protected:
  std::vector<std::string> all_pages(const std::string& verb, const std::string& arguments,
                                     const std::string& path) {
    std::vector<std::string> all;
    for (std::string query = "verb=" + verb + arguments; !query.empty(); ++pages_) {
      const std::string xml = pages_ == 0 ? ask(query) : unchecked(query);
      const auto values = values_in_xml(xml, path);
      EXPECT_FALSE(values.empty());
      const auto tokens = values_in_xml(xml, "//resumptionToken");
      const auto cursors = values_in_xml(xml, "//resumptionToken/@cursor");
      if (!cursors.empty()) {
        EXPECT_EQ(cursors[0], std::to_string(all.size()));
      }
      all.insert(all.end(), values.begin(), values.end());
      query = tokens.empty() || tokens[0].empty()
                  ? ""
                  : "verb=" + verb + "&resumptionToken=" + tokens[0];
    }
    return all;
  }

  int pages_ = 0;
};

TEST_F(OaiPages, HaveEachRecordOnce) {
  std::set<std::string> added;
  for (std::uint32_t i = 0; i < 2 * kOaiPage + 1; ++i)
    added.insert(id_of(add("Bust", "Busts")));
  const auto listed =
      all_pages("ListIdentifiers", "&metadataPrefix=edm&set=Busts&from=2001-01-01", "//identifier");
  EXPECT_EQ(std::set(listed.begin(), listed.end()), added);
  EXPECT_EQ(listed.size(), added.size());
  EXPECT_EQ(pages_, 3);
  EXPECT_THAT(
      ask_for("verb=ListIdentifiers&metadataPrefix=edm", "//resumptionToken/@completeListSize"),
      ElementsAre("201"));
}

TEST_F(OaiPages, HaveEachSetOnce) {
  for (std::uint32_t i = 0; i < kOaiPage + 1; ++i)
    add("Bust", fmt::format("Collection {:03}", i));
  EXPECT_EQ(all_pages("ListSets", "", "//setName").size(), kOaiPage + 1);
  EXPECT_EQ(pages_, 2);
}

TEST_F(OaiPages, AreShorterIfTheTextsAreLong) {
  ModelRecord model{.state = ModelState::kPublished};
  model.more["description"] = std::string(16'384, 'a');
  constexpr std::size_t kModels = 2 * kOaiPageBytes / 16'384;  // as many as fill two pages
  for (std::size_t i = 0; i < kModels; ++i) {
    model.id = ModelId::generate();
    ASSERT_TRUE(catalogue_->add(model, {}));
  }
  EXPECT_EQ(all_pages("ListRecords", "&metadataPrefix=oai_dc", "//header/identifier").size(),
            kModels);
  EXPECT_GE(pages_, 2);
}

TEST_F(OaiPages, AreBoundedIfTheTextsHaveManyValues) {
  ModelRecord model{.state = ModelState::kPublished};
  for (const char* name : {"contributor", "technique", "type"}) {
    for (int i = 0; i < 800; ++i)
      model.more[name] += fmt::format("{};", i);
  }
  for (std::uint32_t i = 0; i < kOaiPage; ++i) {
    model.id = ModelId::generate();
    ASSERT_TRUE(catalogue_->add(model, {}));
  }
  EXPECT_LT(unchecked("verb=ListRecords&metadataPrefix=lido").size(), 2 * kOaiPageBytes);
}

TEST_F(OaiPages, LackNoModelThatIsChangedOrWithdrawnMeanwhile) {
  std::vector<ModelId> added;
  for (std::uint32_t i = 0; i < kOaiPage + 2; ++i)
    added.push_back(add("Bust"));
  changed_at(1'000'000'000);
  const std::string list = "verb=ListIdentifiers&metadataPrefix=edm";
  const std::string first = unchecked(list);
  auto listed = values_in_xml(first, "//identifier");
  ModelRecord changed = *catalogue_->find(added[0]).value();
  changed.title = "Head";
  ASSERT_TRUE(catalogue_->update(changed, std::nullopt));
  ASSERT_TRUE(catalogue_->set_state(added.back(), ModelState::kDraft));
  const auto rest = ask_for(
      "verb=ListIdentifiers&resumptionToken=" + values_in_xml(first, "//resumptionToken").at(0),
      "//identifier");
  EXPECT_EQ(rest.size(), 2u);  // the model that was not listed yet, and the changed one
  EXPECT_EQ(rest.back(), id_of(added[0]));
  listed.insert(listed.end(), rest.begin(), rest.end());
  EXPECT_EQ(std::set(listed.begin(), listed.end()).size(), added.size() - 1);
}

TEST_F(Oai, RefusesTokensThatItDoesNotMake) {
  const std::string id = add("Bust", "Busts").to_string();
  const std::string good = "oai_dc::::0:" + ModelId().to_string() + ":0:1";
  EXPECT_THAT(ask_for("verb=ListRecords&resumptionToken=" + good, "//dc:title"),
              ElementsAre("Bust"));
  for (const std::string& wrong :
       {std::string(), std::string("x"), "marc::::0:" + id + ":0:1", "oai_dc:a:::0:" + id + ":0:1",
        "oai_dc::::0:" + id.substr(1) + ":0:1", "oai_dc::::0:" + id + "::1",
        "oai_dc:::-:0:" + id + ":0:1", "oai_dc::::0:" + id + ":0:1:", "oai_dc::::0:" + id + ":0",
        "oai_dc::::0:" + id + ":5000000000:1", "oai_dc::::9999999999:" + id + ":0:1"})
    EXPECT_EQ(error_of("verb=ListRecords&resumptionToken=" + wrong), "badResumptionToken") << wrong;
  EXPECT_EQ(error_of("verb=ListSets&resumptionToken=x"), "badResumptionToken");
  EXPECT_EQ(error_of("verb=ListSets&resumptionToken=after:Busts"), "badResumptionToken");
}

TEST_F(Oai, NamesTheFaultOfARequest) {
  for (const char* query : {"", "verb=", "verb=Nonsense", "verb=Identify&verb=Identify"})
    EXPECT_EQ(error_of(query), "badVerb") << query;
  const std::string list = "verb=ListRecords&metadataPrefix=oai_dc";
  for (const std::string& query :
       {std::string("verb=Identify&set=a"), std::string("verb=GetRecord&metadataPrefix=edm"),
        std::string("verb=GetRecord&identifier=a"), std::string("verb=ListRecords"),
        list + "&metadataPrefix=edm", list + "&from=2001", list + "&from=2001-02-29",
        list + "&from=2001-01-01T00:00:00", list + "&from=2001-01-01&until=2001-01-01T00:00:00Z",
        list + "&from=2001-01-02&until=2001-01-01", list + "&resumptionToken=x", list + "&x=y"})
    EXPECT_EQ(error_of(query), "badArgument") << query;
  for (const char* arguments :
       {"=", "=a+b", "=%C3%84", "=marc21&from=yesterday", "=marc21&set=%20"})
    EXPECT_EQ(error_of(std::string("verb=ListRecords&metadataPrefix") + arguments), "badArgument")
        << arguments;
  EXPECT_EQ(error_of("verb=ListRecords&metadataPrefix=marc21"), "cannotDisseminateFormat");
  EXPECT_EQ(error_of("verb=ListMetadataFormats&identifier="), "idDoesNotExist");
  for (const char* id : {"", "x", "oai:museum.example:", "oai:other.example:0000"})
    EXPECT_EQ(error_of(std::string("verb=GetRecord&metadataPrefix=edm&identifier=") + id),
              "idDoesNotExist")
        << id;
}

TEST_F(Oai, RepeatsTheArgumentsUnlessTheyAreFaulty) {
  EXPECT_THAT(ask_for("verb=ListRecords&metadataPrefix=edm&set=a", "//request/@set"),
              ElementsAre("a"));
  EXPECT_THAT(ask("verb=Identify&x=<y"), HasSubstr("<request>https://museum.example/api/v1/oai<"));
  EXPECT_THAT(ask("verb=GetRecord&metadataPrefix=edm&identifier=%00%01%3C&"),
              Not(HasSubstr("\x01")));
}

TEST(OaiSets, NameEachCollectionDifferently) {
  for (const std::string& name : {std::string("Vases"), std::string("a_20b"), std::string("a b"),
                                  std::string("Ägypten: 1/2"), std::string("\x00\x7F", 2)})
    EXPECT_EQ(collection_of(set_spec(name)), name);
  for (const char* wrong : {"", "a b", "_", "_2", "_2g", "_41", "_c3", "a:b"})
    EXPECT_FALSE(collection_of(wrong)) << wrong;
}

}  // namespace
}  // namespace vitrine::server
