// SPDX-License-Identifier: Apache-2.0
// Tests that notes and tours are stored with their model: who may see and change them, and how
// viewers and IIIF clients find them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "server/messages/request_body.h"
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

// The notes of another catalogue, in which a hook makes a change before each put().
class ContestedNotes final : public NoteCatalogue {
 public:
  ContestedNotes(NoteCatalogue& notes, std::function<void()> before_put)
      : notes_(notes), before_put_(std::move(before_put)) {}
  Expected<NoteSheet> find(const ModelId& model, NoteKind kind) override {
    return notes_.find(model, kind);
  }
  Expected<void> put(const ModelId& model, NoteKind kind, const NoteSheet& sheet) override {
    before_put_();
    return notes_.put(model, kind, sheet);
  }

 private:
  NoteCatalogue& notes_;
  const std::function<void()> before_put_;
};

// Called before a PUT stores its notes. A handler is a plain function, so that it finds this only
// in a variable.
std::function<void(Services& services)> before_put;

// Answers PUT like the daemon, but calls `before_put` before the notes are stored.
Response contested_put(const Request& request, Services& real) {
  ContestedNotes notes(real.notes, [&] { before_put(real); });
  Services services{.store = real.store,
                    .catalogue = real.catalogue,
                    .tokens = real.tokens,
                    .models = real.models,
                    .scans = real.scans,
                    .uploads = real.uploads,
                    .quota = real.quota,
                    .collector = real.collector,
                    .scrubber = real.scrubber,
                    .webhooks = real.webhooks,
                    .exports = real.exports,
                    .pages = real.pages,
                    .settings = real.settings,
                    .metrics = real.metrics,
                    .visits = real.visits,
                    .notes = notes,
                    .log = real.log,
                    .errors = real.errors};
  const auto routes = public_routes();
  const auto put =
      std::ranges::find(routes, "putNotes", [](const ApiRoute& r) { return r.doc.id; });
  return put->handler(request, services);
}

constexpr ApiRoute kContested[] = {{.method = Method::kPut,
                                    .path = "/api/v1/models/{id}/contested",
                                    .handler = contested_put,
                                    .executor = Executor::kDisk,
                                    .role = Role::kOperator}};

// The test's route is first, because the last routes of the daemon match any path.
std::vector<ApiRoute> all_routes() {
  std::vector<ApiRoute> all(std::begin(kContested), std::end(kContested));
  const auto routes = public_routes();
  all.insert(all.end(), routes.begin(), routes.end());
  return all;
}

class NotesApi : public testing::Test {
 protected:
  HttpAnswer get(const std::string& path, const std::string& fields = "") {
    return test::HttpClient(server_.port()).get(path, fields);
  }
  json shown(const std::string& path) { return json::parse(get(path).body); }
  HttpAnswer put(const std::string& rest, const json& body, const std::string& fields,
                 const char* method = "PUT") {
    test::HttpClient client(server_.port());
    const std::string text = body.dump();
    client.send(
        fmt::format("{} {}{} HTTP/1.1\r\nHost: a\r\n{}Content-Type: application/json\r\n"
                    "Content-Length: {}\r\n\r\n{}",
                    method, api_, rest, fields, text.size(), text));
    return client.receive();
  }
  HttpAnswer put(const json& notes) { return put("/notes", {{"notes", notes}}, operator_); }
  std::string header() { return get(api_ + "/head").field("vitrine-presentation"); }

  // In the next `count` calls of put() by a PUT, another change comes first, so the call fails.
  void contest(int count) {
    before_put = [count, id = id_](Services& services) mutable {
      if (count-- <= 0) return;
      const NoteSheet now = services.notes.find(id, NoteKind::kNotes).value();
      ASSERT_TRUE(services.notes.put(id, NoteKind::kNotes, {now.version, 0, "[]"}));
    };
  }

  const std::vector<ApiRoute> routes_ = all_routes();
  test::LocalServer server_{routes_};
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

TEST_F(NotesApi, AChangeThatLosesARaceIsRepeatedOnceUnlessItNamesAState) {
  const json body = {{"notes", {kEar}}};
  contest(1);
  EXPECT_EQ(put("/contested", body, operator_).status, 200);
  EXPECT_EQ(shown(api_ + "/notes"), body);
  contest(2);
  EXPECT_EQ(put("/contested", body, operator_).status, 409);
  EXPECT_EQ(shown(api_ + "/notes")["notes"], json::array());
  contest(1);
  const std::string read = "If-Match: " + get(api_ + "/notes").field("etag") + "\r\n";
  EXPECT_EQ(put("/contested", body, operator_ + read).status, 412);
}

TEST_F(NotesApi, AModelThatIsRemovedMeanwhileIsNotFound) {
  before_put = [this](Services& services) {
    ASSERT_TRUE(services.catalogue.remove(id_, std::nullopt));
  };
  const HttpAnswer answer = put("/contested", {{"notes", {kEar}}}, operator_);
  EXPECT_EQ(answer.status, 404);
  EXPECT_EQ(json::parse(answer.body)["detail"], "there is no such model");
}

TEST_F(NotesApi, AClientThatCanOnlyPostNamesItsMethod) {
  const json body = {{"notes", {kEar}}};
  const std::string method = "X-HTTP-Method-Override: PUT\r\n";
  EXPECT_EQ(put("/notes", body, operator_, "POST").status, 405);
  EXPECT_EQ(put("/notes", body, operator_ + method, "POST").status, 200);
  EXPECT_EQ(shown(api_ + "/notes"), body);
}

TEST_F(NotesApi, ABodyMayHaveAMegabyteOnlyWithAToken) {
  json note = kEar;
  for (const char* language : {"en", "de", "fr", "it"})
    note["texts"][language] = {{"title", language}, {"text", std::string(8'000, 'a')}};
  json notes = json::array();
  for (const char* id : {"a", "b", "c", "d"}) {
    notes.push_back(note);
    notes.back()["id"] = id;
  }
  EXPECT_EQ(put(notes).status, 200);
  EXPECT_EQ(shown(api_ + "/notes")["notes"], notes);
  const json too_large = {{"notes", {std::string(kMaxLargeRequestBody, 'a')}}};
  for (const char* path : {"/notes", "/tours"})
    EXPECT_EQ(put(path, too_large, operator_).status, 413) << path;
  for (const ApiRoute& route : public_routes())
    EXPECT_TRUE(route.body != BodyKind::kLargeJson || route.role >= Role::kOperator) << route.path;
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
  json many = kEar;
  for (int i = 0; i < 1000; ++i)
    many["x" + std::to_string(i)] = 1;
  EXPECT_EQ(json::parse(put(json::array({many})).body)["errors"].size(), 100u);
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

TEST_F(NotesApi, ADamagedNoteIsLeftOutOfTheAnnotations) {
  const json damaged[] = {kEar,
                          3,
                          json::object(),
                          {{"id", "a"}, {"texts", {{"en", 3}}}},
                          {{"id", "a"}, {"texts", 3}, {"position", {1}}}};
  const std::string text = json(damaged).dump();
  ASSERT_TRUE(server_.services().notes.put(id_, NoteKind::kNotes, {0, 5, text}));
  server_.services().models.refresh();
  for (const char* version : {"", "4/"}) {
    const std::string path = fmt::format("/api/v1/iiif/{}{}", version, id_.to_string());
    EXPECT_EQ(shown(path + "/annotations.json")["items"].size(), 1u);
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
