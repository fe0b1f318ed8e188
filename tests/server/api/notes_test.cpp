// SPDX-License-Identifier: Apache-2.0
// Tests that notes and tours are stored with their model: who may see and change them, and how
// viewers and IIIF clients find them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "server/store/change.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;

const json kEar = {{"id", "ear"},
                   {"position", {1, 2, 3}},
                   {"texts",
                    {{"en", {{"title", "Ear"}, {"text", "In plaster."}, {"audio", "/a.mp3"}}},
                     {"de", {{"title", "Ohr"}}}}},
                   {"picture", "https://museum.example/ear.jpg"}};

class NotesApi : public testing::Test {
 protected:
  HttpAnswer get(const std::string& path, const std::string& fields = "") {
    return test::HttpClient(server_.port()).get(path, fields);
  }
  json shown(const std::string& path) { return json::parse(get(path).body); }
  HttpAnswer put(const std::string& rest, const json& body, const std::string& fields) {
    test::HttpClient client(server_.port());
    const std::string text = body.dump();
    client.send(
        fmt::format("PUT {}{} HTTP/1.1\r\nHost: a\r\n{}Content-Type: application/json\r\n"
                    "Content-Length: {}\r\n\r\n{}",
                    api_, rest, fields, text.size(), text));
    return client.receive();
  }
  HttpAnswer put(const json& notes) { return put("/notes", {{"notes", notes}}, operator_); }
  std::string header() { return get(api_ + "/head").field("vitrine-presentation"); }

  test::LocalServer server_{public_routes()};
  const std::string operator_ = server_.bearer(Role::kOperator);
  const ModelId id_ = publish(server_.store(), server_.catalogue(),
                              test::tiny_pmesh("the base", "a chunk").bytes, {.title = "Bust"}, {})
                          ->id;
  const std::string api_ = "/api/v1/models/" + id_.to_string();
};

TEST_F(NotesApi, WhatIsPutIsRead) {
  EXPECT_EQ(shown(api_ + "/notes"), (json{{"notes", json::array()}}));
  EXPECT_EQ(shown(api_ + "/tours"), (json{{"tours", json::array()}}));
  const HttpAnswer answer = put(json::array({kEar}));
  EXPECT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(shown(api_ + "/notes"), (json{{"notes", {kEar}}}));
  EXPECT_EQ(json::parse(answer.body), shown(api_ + "/notes"));
  EXPECT_EQ(answer.field("etag"), get(api_ + "/notes").field("etag"));
  const json tours = {
      {"tours", {{{"id", "t"}, {"titles", {{"en", "Tour"}}}, {"steps", {{{"note", "ear"}}}}}}}};
  EXPECT_EQ(put("/tours", tours, operator_).status, 200);
  EXPECT_EQ(shown(api_ + "/tours"), tours);
  EXPECT_EQ(shown(api_)["links"]["notes"], api_ + "/notes");
  const HttpAnswer methods = test::http_get(server_.port(), api_ + "/notes", "", "OPTIONS");
  EXPECT_EQ(methods.field("allow"), "GET, HEAD, PUT, OPTIONS");
}

TEST_F(NotesApi, ChangeNeedsAnOperatorAndTheStateThatWasRead) {
  const json body = {{"notes", {kEar}}};
  EXPECT_EQ(put("/notes", body, "X: y\r\n").status, 401);
  EXPECT_EQ(put("/notes", body, server_.bearer(Role::kViewer)).status, 403);
  const std::string read = "If-Match: " + get(api_ + "/notes").field("etag") + "\r\n";
  EXPECT_EQ(put("/notes", body, operator_ + read).status, 200);
  EXPECT_EQ(put("/notes", {{"notes", json::array()}}, operator_ + read).status, 412);
  EXPECT_EQ(shown(api_ + "/notes"), body);
  const std::string now = "If-Match: " + get(api_ + "/notes").field("etag") + "\r\n";
  EXPECT_EQ(put("/notes", {{"notes", json::array()}}, operator_ + now).status, 200);
  EXPECT_EQ(header(), "") << "the last note is gone";
}

TEST_F(NotesApi, SavingNotesDoesNotDisturbAFormOfTheModel) {
  const std::string before = get(api_).field("etag");
  EXPECT_EQ(put(json::array({kEar})).status, 200);
  EXPECT_EQ(get(api_).field("etag"), before);
}

TEST_F(NotesApi, WrongFieldsAreNamedAndNothingIsStored) {
  json note = kEar;
  note["texts"]["en"]["title"] = "";
  const HttpAnswer answer = put(json::array({kEar, note}));
  EXPECT_EQ(answer.status, 422);
  const json faults = json::parse(answer.body)["errors"];
  EXPECT_EQ(faults[0]["parameter"], "notes.1.texts.en.title");
  EXPECT_EQ(put("/notes", {{"tours", json::array()}}, operator_).status, 422);
  EXPECT_EQ(put("/notes", json::object(), operator_).status, 422);
  EXPECT_EQ(put("/notes", {{"notes", 3}}, operator_).status, 422);
  EXPECT_EQ(shown(api_ + "/notes")["notes"], json::array());
  const std::string large(70'000, 'a');
  EXPECT_EQ(put("/notes", {{"notes", {large}}}, operator_).status, 413);
}

TEST_F(NotesApi, NotesAreAsVisibleAsTheirModel) {
  EXPECT_EQ(put(json::array({kEar})).status, 200);
  ASSERT_TRUE(server_.catalogue().set_state(id_, ModelState::kDraft));
  server_.services().models.refresh();
  const std::string iiif = "/api/v1/iiif/" + id_.to_string();
  for (const std::string& path : {api_ + "/notes", api_ + "/tours", iiif + "/annotations.json"}) {
    EXPECT_EQ(get(path).status, 404) << path;
    EXPECT_EQ(get(path, server_.bearer(Role::kViewer)).status, 200) << path;
  }
  EXPECT_EQ(put(json::array({kEar})).status, 200) << "a draft's notes can be written";
  const std::string none = "/api/v1/models/" + ModelId::generate().to_string();
  EXPECT_EQ(get(none + "/notes").status, 404);
}

TEST_F(NotesApi, TheHeadSaysThatThereAreNotesSoThatOthersNeedNoRequest) {
  const HttpAnswer plain = get(api_ + "/head");
  EXPECT_EQ(plain.field("vitrine-presentation"), "");
  EXPECT_EQ(put(json::array({kEar})).status, 200);
  EXPECT_EQ(json::parse(header())["notes"], 1);
  EXPECT_NE(get(api_ + "/head").field("etag"), plain.field("etag"));
}

TEST_F(NotesApi, IiifManifestsReferToThemAsAnnotations) {
  const std::string three = "/api/v1/iiif/" + id_.to_string(),
                    four = "/api/v1/iiif/4/" + id_.to_string();
  EXPECT_FALSE(shown(three + "/manifest.json")["items"][0].contains("annotations"));
  EXPECT_EQ(put(json::array({kEar})).status, 200);
  for (const std::string& self : {three, four}) {
    const json container = shown(self + "/manifest.json")["items"][0];
    const std::string page_url = container["annotations"][0]["id"];
    EXPECT_TRUE(page_url.ends_with(self + "/annotations.json")) << page_url;
    const json page = shown(self + "/annotations.json");
    EXPECT_EQ(page["id"], page_url);
    const json note = page["items"][0];
    EXPECT_EQ(note["label"], (json{{"en", {"Ear"}}, {"de", {"Ohr"}}}));
    EXPECT_EQ(note["body"].size(), 4u);
    EXPECT_EQ(note["body"][1]["value"], "In plaster.");
    const std::string sound = note["body"][2]["id"];
    EXPECT_TRUE(sound.starts_with("http://") && sound.ends_with("/a.mp3")) << sound;
    EXPECT_EQ(note["body"][3]["type"], "Image");
    const json target = note["target"];
    EXPECT_EQ(self == three ? target : target["source"][0]["id"], container["id"]);
  }
}

TEST_F(NotesApi, PointsInTheSceneAreThoseOfTheGlb) {
  EXPECT_EQ(put(json::array({kEar})).status, 200);
  ModelRecord record = server_.catalogue().find(id_).value().value();
  record.unit = "cm";
  record.presentation.scale = 10;
  record.presentation.rotation = {0, 0, 0, 1};
  ASSERT_TRUE(server_.catalogue().update(record, std::nullopt));
  server_.services().models.refresh();
  const json page = shown("/api/v1/iiif/4/" + id_.to_string() + "/annotations.json");
  const json point = page["items"][0]["target"]["selector"][0];
  EXPECT_NEAR(point["x"], 0.1, 1e-12);
  EXPECT_NEAR(point["y"], 0.2, 1e-12);
  EXPECT_NEAR(point["z"], 0.3, 1e-12);
}

}  // namespace
}  // namespace vitrine::server
