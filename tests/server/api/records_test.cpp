// SPDX-License-Identifier: Apache-2.0
// Tests the records of models over HTTP, one by one and by OAI-PMH. tests/server/records tests
// their contents, and visibility_test.cpp what they reveal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RecordsApi : public testing::Test {
 protected:
  ModelId add(const std::string& title) {
    return publish(server_.store(), server_.catalogue(), file_.bytes, {.title = title})->id;
  }
  HttpAnswer get(const std::string& path, const std::string& fields = "") {
    return test::http_get(server_.port(), path, fields);
  }
  HttpAnswer post(const std::string& form,
                  const std::string& type = "application/x-www-form-urlencoded") {
    test::HttpClient client(server_.port());
    client.send(
        fmt::format("POST /api/v1/oai HTTP/1.1\r\nHost: localhost\r\nContent-Type: "
                    "{}\r\nContent-Length: {}\r\n\r\n{}",
                    type, form.size(), form));
    return client.receive();
  }
  static std::string record_path(const ModelId& id, const std::string& format) {
    return fmt::format("/api/v1/models/{}/metadata.{}.xml", id.to_string(), format);
  }

  const test::TinyPmesh file_ = test::tiny_pmesh("the base", "a chunk");
  test::LocalServer server_{public_routes()};
};

TEST_F(RecordsApi, HasARecordInEachFormat) {
  const ModelId id = add("Ewer <1>");
  for (const auto& [format, root] : {std::pair("dc", "<oai_dc:dc "), std::pair("edm", "<rdf:RDF "),
                                     std::pair("lido", "<lido:lido ")}) {
    const HttpAnswer answer = get(record_path(id, format));
    EXPECT_EQ(answer.status, 200) << format;
    EXPECT_EQ(answer.field("content-type"), "application/xml");
    EXPECT_EQ(answer.field("cache-control"), "no-cache");
    EXPECT_THAT(answer.body, AllOf(HasSubstr(root), HasSubstr("Ewer &lt;1&gt;")));
    EXPECT_THAT(answer.body, HasSubstr("/models/" + id.to_string()));
  }
  EXPECT_EQ(get(record_path(id, "marc")).status, 404);
}

TEST_F(RecordsApi, HidesTheRecordOfADraftFromVisitors) {
  const ModelId id = add("Ewer");
  ASSERT_TRUE(server_.catalogue().set_state(id, ModelState::kDraft));
  server_.services().models.refresh();
  for (const char* format : {"dc", "edm", "lido"}) {
    EXPECT_EQ(get(record_path(id, format)).status, 404) << format;
    const HttpAnswer answer = get(record_path(id, format), server_.bearer(Role::kViewer));
    EXPECT_EQ(answer.status, 200) << format;
    EXPECT_EQ(answer.field("cache-control"), "private, no-store") << format;
  }
}

TEST_F(RecordsApi, IsLinkedFromThePageOfTheModel) {
  const ModelId id = add("Ewer");
  const std::string page = get("/models/" + id.to_string()).body;
  for (const char* format : {"dc", "edm", "lido"})
    EXPECT_THAT(page, HasSubstr(record_path(id, format) + "\">"));
}

TEST_F(RecordsApi, IsLinkedFromTheIiifManifestWithTheIdentifiers) {
  const ModelMetadata texts{.title = "Ewer", .more = {{"doi", "10.5281/zenodo.1"}}};
  const ModelId id = publish(server_.store(), server_.catalogue(), file_.bytes, texts)->id;
  const auto manifest = json::parse(get("/api/v1/iiif/" + id.to_string() + "/manifest.json").body);
  std::string linked;
  for (const json& link : manifest["seeAlso"])
    linked += link["id"].get<std::string>() + '\n';
  for (const char* format : {"dc", "edm", "lido"})
    EXPECT_THAT(linked, HasSubstr(record_path(id, format)));
  EXPECT_THAT(manifest["metadata"].dump(), HasSubstr("https://doi.org/10.5281/zenodo.1"));
}

TEST_F(RecordsApi, IsCitedByTheModel) {
  const ModelId id = add("Ewer");
  const auto citation = json::parse(get("/api/v1/models/" + id.to_string()).body)["citation"];
  for (const char* style : {"apa", "chicago", "mla"}) {
    EXPECT_THAT(citation[style].get<std::string>(),
                AllOf(HasSubstr("Ewer"), HasSubstr("/models/" + id.to_string())));
  }
}

TEST_F(RecordsApi, HasAnotherTagIfTheCitationHasAnotherAddress) {
  const std::string path = "/api/v1/models/" + add("Ewer").to_string();
  const std::string tag = get(path).field("etag");
  EXPECT_EQ(get(path, "If-None-Match: " + tag + "\r\n").status, 304);
  Settings settings = server_.settings().get();
  settings.public_url = "https://museum.example";
  server_.settings().replace(settings);
  EXPECT_EQ(get(path, "If-None-Match: " + tag + "\r\n").status, 200);
}

TEST_F(RecordsApi, IsHarvestedByGetAndByPost) {
  const ModelId id = add("Ewer");
  const std::string arguments = "verb=ListRecords&metadataPrefix=oai_dc";
  for (const HttpAnswer& answer : {get("/api/v1/oai?" + arguments), post(arguments)}) {
    EXPECT_EQ(answer.status, 200);
    EXPECT_EQ(answer.field("content-type"), "text/xml; charset=utf-8");
    EXPECT_THAT(answer.body, HasSubstr("<dc:title>Ewer</dc:title>"));
    EXPECT_THAT(answer.body, HasSubstr("<identifier>oai:localhost:" + id.to_string() + "<"));
  }
}

TEST_F(RecordsApi, IsHarvestedWithoutDraftsEvenWithAToken) {
  const ModelId id = add("Ewer");
  ASSERT_TRUE(server_.catalogue().set_state(id, ModelState::kDraft));
  const HttpAnswer answer =
      get("/api/v1/oai?verb=ListRecords&metadataPrefix=edm", server_.bearer(Role::kAdmin));
  EXPECT_THAT(answer.body, AllOf(HasSubstr("code=\"noRecordsMatch\""), Not(HasSubstr("Ewer"))));
}

TEST_F(RecordsApi, RefusesABodyThatIsNoShortForm) {
  for (const char* type : {"application/json", "application/x-www-form-urlencodedX", ""})
    EXPECT_EQ(post("verb=Identify", type).status, 415) << type;
  EXPECT_EQ(post("verb=Identify", "Application/X-WWW-Form-Urlencoded; charset=utf-8").status, 200);
  EXPECT_EQ(post("verb=Identify&x=" + std::string(8 * 1024, 'a')).status, 413);
  EXPECT_EQ(post("verb=%G0").status, 400);
  EXPECT_EQ(get("/api/v1/oai?verb=%G0").status, 400);
  EXPECT_THAT(post("").body, HasSubstr("code=\"badVerb\""));
}

TEST_F(RecordsApi, StatesTheContactOfTheSettings) {
  Settings settings = server_.settings().get();
  settings.contact = "3d@museum.example";
  settings.public_url = "https://museum.example";
  server_.settings().replace(settings);
  EXPECT_THAT(get("/api/v1/oai?verb=Identify").body,
              AllOf(HasSubstr("<adminEmail>3d@museum.example</adminEmail>"),
                    HasSubstr("<baseURL>https://museum.example/api/v1/oai</baseURL>")));
}

}  // namespace
}  // namespace vitrine::server
