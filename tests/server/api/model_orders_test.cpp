// SPDX-License-Identifier: Apache-2.0
// Tests requests that make models from uploads, and that change, limit, replace and delete models.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>

#include "codec/export/write_mesh.h"
#include "codec/format/manifest.h"
#include "server/api/handlers.h"
#include "server/api/routes.h"
#include "server/metadata/text.h"
#include "support/local_server.h"
#include "support/meshes.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;
using testing::HasSubstr;
using testing::Not;

std::string ply_of(const TriangleMesh& mesh) {
  const auto bytes = write_mesh(mesh, MeshFormat::kPly, {.unit = "mm"}).value();
  return {bytes.begin(), bytes.end()};
}

class ModelOrders : public testing::Test {
 protected:
  ModelOrders() { EXPECT_TRUE(server_.scans().start()); }

  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& who,
                 const json& body = nullptr, const std::string& fields = "") {
    const std::string text = body.is_null() ? "" : body.dump();
    const std::string about = text.empty() ? "" : "Content-Type: application/json\r\n";
    return send(method, path, who + fields + about, text);
  }
  HttpAnswer send(const std::string& method, const std::string& path, const std::string& fields,
                  const std::string& body) {
    HttpClient client(server_.port());
    client.send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  }
  std::string upload(const std::string& bytes) {
    const HttpAnswer made = send(
        "POST", "/uploads",
        operator_ + "Tus-Resumable: 1.0.0\r\nContent-Type: application/offset+octet-stream\r\n" +
            "Upload-Length: " + std::to_string(bytes.size()) + "\r\n",
        bytes);
    EXPECT_EQ(made.status, 201) << made.body;
    const std::string path = made.field("location");
    return path.substr(path.rfind('/') + 1);
  }
  // Returns once all earlier tasks are done.
  void settle() {
    server_.scans().jobs().executor("").run([] {});
    // Without this, the cache could return the old state of a model for a tenth of a second.
    server_.services().models.refresh();
  }
  json job_of(const HttpAnswer& accepted) {
    EXPECT_EQ(accepted.status, 202) << accepted.body;
    settle();
    const std::string path = accepted.field("location").substr(std::string("/api/v1").size());
    return json::parse(ask("GET", path, operator_).body);
  }
  // Publishes a model made from `bytes` and returns its ID.
  std::string publish(const std::string& bytes, const json& more = json::object()) {
    json order = {{"upload", upload(bytes)}, {"publish", true}, {"bits", 12}};
    order.update(more);
    const json job = job_of(ask("POST", "/models", operator_, order));
    EXPECT_EQ(job["state"], "done") << job;
    return job.value("model", "");
  }
  json model(const std::string& id, const std::string& who = "") {
    return json::parse(ask("GET", "/models/" + id, who).body);
  }
  static std::string fault_of(const HttpAnswer& answer) {
    EXPECT_EQ(answer.status, 422) << answer.body;
    return json::parse(answer.body)["errors"].at(0)["parameter"];
  }
  std::size_t objects() {
    std::size_t count = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(server_.data() / "objects"))
      count += entry.is_regular_file() ? 1 : 0;
    return count;
  }

  LocalServer server_{public_routes()};
  const std::string operator_ = server_.bearer(Role::kOperator);
  const std::string mesh_ = ply_of(test::torus(40, 20));
};

TEST_F(ModelOrders, AMeshThatWasUploadedBecomesAModel) {
  const std::string id = publish(
      mesh_,
      {{"metadata", {{"title", "A torus"}, {"creator", "A. N. Other"}, {"description", "round"}}}});
  const json shown = model(id);
  EXPECT_EQ(shown["title"], "A torus");
  EXPECT_EQ(shown["description"], "round");
  EXPECT_EQ(shown["faces"], 1'600);
  EXPECT_EQ(shown["state"], "published");
  EXPECT_TRUE(server_.uploads().list().value().empty());
  const JobRecord job = server_.jobs().jobs({}).value().at(0);
  EXPECT_TRUE(TokenId::parse(job.owner)) << "the token of the upload shares the builders";
}

TEST_F(ModelOrders, AnUploadThatAJobOfAnotherDaemonNeedsStays) {
  const std::string id = upload("no mesh");
  const JobRecord job = PublishJobs::job_for({.upload = UploadId::parse(id).value()}, TokenId());
  ASSERT_TRUE(server_.jobs().add(job, {}, {}));
  auto held = server_.jobs().claim(job.id, {"another daemon", std::chrono::minutes(1)}).value();
  ASSERT_TRUE(held);
  const auto remove = [&] {
    return ask("DELETE", "/uploads/" + id, operator_, nullptr, "Tus-Resumable: 1.0.0\r\n").status;
  };
  EXPECT_EQ(remove(), 409);
  held->state = JobState::kCancelled;
  ASSERT_TRUE(server_.jobs().update(*held));
  EXPECT_EQ(remove(), 204);
}

TEST_F(ModelOrders, AnUploadIsUsedOrTakenAwayWhoeverComesFirst) {
  for (int round = 0; round < 20; ++round) {
    const std::string id = upload("no mesh");
    // Blocks the jobs until the test has received both responses. Otherwise the first job could
    // end, and no longer need the upload, before the second request.
    std::promise<void> both;
    server_.scans().jobs().executor("").post([all = both.get_future().share()] { all.wait(); });
    auto made = std::async(std::launch::async, [&] {
      return ask("POST", "/models", operator_, {{"upload", id}});
    });
    const HttpAnswer removed =
        ask("DELETE", "/uploads/" + id, operator_, nullptr, "Tus-Resumable: 1.0.0\r\n");
    const HttpAnswer accepted = made.get();
    both.set_value();
    if (accepted.status == 202) {
      EXPECT_NE(removed.status, 204) << "a job needs it";
      settle();
      ASSERT_TRUE(server_.uploads().remove(UploadId::parse(id).value()));
    } else {
      EXPECT_EQ(fault_of(accepted), "upload");
      EXPECT_EQ(removed.status, 204) << removed.body;
    }
  }
}

TEST_F(ModelOrders, UnitAndAxisAreTheOrders) {
  const std::string id = publish(mesh_, {{"unit", "cm"}, {"up", "z"}, {"placement", "pyramid"}});
  EXPECT_EQ(model(id)["unit"], "cm");
  const json manifest = json::parse(ask("GET", "/models/" + id + "/manifest", "").body);
  EXPECT_EQ(manifest["placement"], "pyramid");
}

TEST_F(ModelOrders, APmeshIsVerifiedAndPublishedAsItIs) {
  const std::string id = publish(mesh_);
  const std::string file = ask("GET", "/models/" + id + "/file.pmesh", "").body;
  const std::string again = publish(file, {{"metadata", {{"title", "again"}}}});
  EXPECT_EQ(ask("GET", "/models/" + again + "/file.pmesh", "").body, file);
  std::string damaged = file;
  damaged[damaged.size() - 9] ^= 1;
  const json job = job_of(ask("POST", "/models", operator_, {{"upload", upload(damaged)}}));
  EXPECT_EQ(job["state"], "failed");
  EXPECT_THAT(job["error"].get<std::string>(), HasSubstr("damaged"));
}

// A tetrahedron as OBJ. One of its faces occurs twice.
constexpr const char* kTwice =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 3 1 4\n";

TEST_F(ModelOrders, RepairsOfTheBuildAreKeptWithTheModelForCallersWithAToken) {
  const std::string id = publish(kTwice), viewer = server_.bearer(Role::kViewer);
  const auto repairs = [&] { return model(id, viewer).at("repairs"); };
  const json built = repairs();
  ASSERT_EQ(built.size(), 1u);
  EXPECT_THAT(built[0].get<std::string>(), HasSubstr("1 duplicate face dropped"));
  EXPECT_FALSE(model(id).contains("repairs"));
  EXPECT_EQ(json::parse(ask("GET", "/models", viewer).body)["models"][0]["repairs"], built);
  EXPECT_FALSE(json::parse(ask("GET", "/models", "").body)["models"][0].contains("repairs"));
  EXPECT_EQ(ask("GET", "/models/" + id, viewer).field("cache-control"), "private, no-store");
  const std::vector<json> changes = {
      {{"title", "A body"}}, {{"unit", "cm"}}, {{"public_max_level", 0}}};
  for (const json& change : changes) {
    EXPECT_EQ(ask("PATCH", "/models/" + id, operator_, change).status, 200) << change;
    EXPECT_EQ(repairs(), built) << change;
    EXPECT_FALSE(model(id).contains("repairs")) << change;
  }
  EXPECT_EQ(publish(mesh_, {{"replace", id}}), id);
  EXPECT_EQ(repairs(), json::array());
  EXPECT_EQ(publish(kTwice, {{"replace", id}}), id);
  EXPECT_EQ(repairs(), built);
}

TEST_F(ModelOrders, AClientThatHasBuiltAFileMayStateItsRepairs) {
  const std::string file = ask("GET", "/models/" + publish(mesh_) + "/file.pmesh", "").body;
  const json stated = {"2 faces of B\u00fcste dropped; check them", "1 picture not carried"};
  const json job =
      job_of(ask("POST", "/models", operator_, {{"upload", upload(file)}, {"repairs", stated}}));
  EXPECT_EQ(job["repairs"], stated) << job;
  EXPECT_EQ(model(job.value("model", ""), operator_)["repairs"], stated);
  const std::string id = publish(kTwice, {{"repairs", stated}});
  EXPECT_THAT(model(id, operator_)["repairs"].dump(), HasSubstr("1 duplicate face dropped"));
  EXPECT_THAT(model(id, operator_)["repairs"].dump(), Not(HasSubstr("picture")));
  const std::string unused = upload(file), long_line(kMaxParagraphBytes, 'x');
  for (const json& wrong : {json{7}, json{"two\nlines"}, json{"\x1b[2J"}, json{long_line, "y"}}) {
    const json order = {{"upload", unused}, {"repairs", wrong}};
    EXPECT_EQ(fault_of(ask("POST", "/models", operator_, order)), "repairs");
  }
}

TEST_F(ModelOrders, WhatIsNoMeshFailsWithTheFaultAndIsNotSeen) {
  for (const std::string bytes :
       {"no mesh at all", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n", ""}) {
    const json job =
        job_of(ask("POST", "/models", operator_, {{"upload", upload(bytes)}, {"publish", true}}));
    EXPECT_EQ(job["state"], "failed") << job;
    EXPECT_THAT(job["error"].get<std::string>(), HasSubstr(";"));
    EXPECT_EQ(job["model"], nullptr);
  }
  EXPECT_EQ(json::parse(ask("GET", "/models?drafts=true", operator_).body)["models"].size(), 0u);
}

TEST_F(ModelOrders, AWrongOrderNamesItsField) {
  const std::string whole = upload(mesh_);
  EXPECT_EQ(fault_of(ask("POST", "/models", operator_, json::object())), "upload");
  EXPECT_EQ(fault_of(ask("POST", "/models", operator_, {{"upload", "../../etc"}})), "upload");
  EXPECT_EQ(fault_of(ask("POST", "/models", server_.bearer(Role::kOperator), {{"upload", whole}})),
            "upload");
  const json wrong = {{"bits", 99},
                      {"unit", "ell"},
                      {"up", "x"},
                      {"replace", "x"},
                      {"publish", 1},
                      {"colour", "red"},
                      {"repairs", "1 face dropped"},
                      {"webhook", "http://elsewhere.example/"}};
  for (const auto& [name, value] : wrong.items()) {
    const json order = {{"upload", whole}, {name, value}};
    EXPECT_EQ(fault_of(ask("POST", "/models", operator_, order)), name);
  }
  const HttpAnswer half =
      send("POST", "/uploads", operator_ + "Tus-Resumable: 1.0.0\r\nUpload-Length: 9\r\n", "");
  const std::string path = half.field("location");
  EXPECT_EQ(
      fault_of(ask("POST", "/models", operator_, {{"upload", path.substr(path.rfind('/') + 1)}})),
      "upload");
  EXPECT_EQ(ask("POST", "/models", server_.bearer(Role::kViewer), {{"upload", whole}}).status, 403);
}

TEST_F(ModelOrders, ARequestThatIsRepeatedWithItsKeyMakesOneModel) {
  const json order = {{"upload", upload(mesh_)}};
  const HttpAnswer first = ask("POST", "/models", operator_, order, "Idempotency-Key: k\r\n");
  settle();
  const HttpAnswer again = ask("POST", "/models", operator_, order, "Idempotency-Key: k\r\n");
  EXPECT_EQ(again.status, 202);
  EXPECT_EQ(again.field("location"), first.field("location"));
  const json other = {{"upload", order["upload"]}, {"publish", true}};
  EXPECT_EQ(fault_of(ask("POST", "/models", operator_, other, "Idempotency-Key: k\r\n")),
            "Idempotency-Key");
  EXPECT_EQ(json::parse(ask("GET", "/models?drafts=true", operator_).body)["models"].size(), 1u);
}

TEST_F(ModelOrders, AModelThatIsReplacedKeepsItsIdAndWhatIsNotSaidAnew) {
  const std::string id =
      publish(mesh_, {{"metadata", {{"title", "Old"}, {"creator", "A. N. Other"}}}});
  const std::string before = model(id)["bytes"].dump();
  const std::string now =
      publish(ply_of(test::torus(30, 20)), {{"replace", id}, {"metadata", {{"title", "New"}}}});
  server_.services().models.refresh();  // without this, the cache could return the old model
  EXPECT_EQ(now, id);
  EXPECT_EQ(model(id)["title"], "New");
  EXPECT_EQ(model(id)["creator"], "A. N. Other");
  EXPECT_EQ(model(id)["faces"], 1'200);
  EXPECT_EQ(objects(), 2u);
  EXPECT_EQ(server_.collector().collect().value().objects, 1u);
  EXPECT_EQ(ask("GET", "/models/" + id + "/file.pmesh", "").status, 200);
}

TEST_F(ModelOrders, TextsAreChangedWhereTheModelIsTheOneThatWasRead) {
  const std::string id = publish(mesh_), path = "/models/" + id;
  const std::string read = "If-Match: " + ask("GET", path, "").field("etag") + "\r\n";
  const HttpAnswer done =
      ask("PATCH", path, operator_,
          {{"title", "Ring"}, {"description", "A ring"}, {"accuracy", 0.05}}, read);
  EXPECT_EQ(done.status, 200) << done.body;
  json shown = model(id, operator_);
  EXPECT_EQ(shown["title"], "Ring");
  EXPECT_EQ(shown["description"], "A ring");
  EXPECT_EQ(shown["accuracy"], 0.05);
  EXPECT_EQ(shown["dimensions"]["unit"], "mm");
  EXPECT_EQ(json::parse(done.body), shown);
  EXPECT_EQ(ask("GET", path, operator_).field("etag"), done.field("etag"));
  EXPECT_EQ(ask("PATCH", path, operator_, {{"title", "Late"}}, read).status, 412);
  EXPECT_EQ(ask("DELETE", path, operator_, nullptr, read).status, 412);
  EXPECT_EQ(model(id)["title"], "Ring");
  EXPECT_EQ(ask("PATCH", path, operator_, {{"metadata", {{"title", "Nested"}}}}).status, 200);
  EXPECT_EQ(model(id)["title"], "Nested");
  EXPECT_EQ(ask("PATCH", path, operator_, {{"creator", "Someone"}}).status, 200);
  const auto without = ask("PATCH", path, operator_, {{"creator", nullptr}, {"unit", nullptr}});
  EXPECT_EQ(nlohmann::json::parse(without.body).at("creator"), "");
  EXPECT_EQ(fault_of(ask("PATCH", path, operator_, {{"faces", 3}})), "faces");
  EXPECT_EQ(fault_of(ask("PATCH", path, operator_, {{"title", "two\nlines"}})), "title");
  const auto parts = ask("PATCH", path, operator_, {{"description", "One.\r\n\r\nTwo."}});
  EXPECT_EQ(parts.status, 200) << parts.body;
  EXPECT_EQ(model(id)["description"], "One.\n\nTwo.");
  const std::string most(kMaxParagraphBytes, 'x');
  EXPECT_EQ(ask("PATCH", path, operator_, {{"rights", most}}).status, 200);
  EXPECT_EQ(fault_of(ask("PATCH", path, operator_, {{"rights", most + 'x'}})), "rights");
  EXPECT_EQ(fault_of(ask("PATCH", path, operator_, {{"description", "a\tb"}})), "description");
  EXPECT_EQ(ask("PATCH", path, server_.bearer(Role::kViewer), {{"title", "x"}}).status, 403);
  EXPECT_EQ(ask("PATCH", path, "", {{"title", "x"}}).status, 401);
}

TEST_F(ModelOrders, TheTagIsAnotherWithEachChangeThoughTheTextsAreThoseOfBefore) {
  const std::string id = publish(mesh_, {{"metadata", {{"title", "Ring"}}}}),
                    path = "/models/" + id;
  const HttpAnswer before = ask("GET", path, "");
  for (const char* title : {"Hoop", "Ring"})
    EXPECT_EQ(ask("PATCH", path, operator_, {{"title", title}}).status, 200);
  const HttpAnswer after = ask("GET", path, "");
  EXPECT_EQ(after.body, before.body);
  EXPECT_NE(after.field("etag"), before.field("etag"));
}

TEST_F(ModelOrders, OfThoseWhoHaveReadTheSameStateOneChangesIt) {
  const std::string id = publish(mesh_), path = "/models/" + id;
  for (int round = 0; round < 5; ++round) {
    const std::string read = "If-Match: " + ask("GET", path, operator_).field("etag") + "\r\n";
    std::vector<std::future<unsigned>> answers;
    for (int i = 0; i < 6; ++i) {
      answers.push_back(std::async(std::launch::async, [&, i] {
        return static_cast<unsigned>(
            ask("PATCH", path, operator_, {{"title", "by " + std::to_string(i)}}, read).status);
      }));
    }
    std::map<unsigned, int> count;
    for (auto& answer : answers)
      ++count[answer.get()];
    EXPECT_EQ(count, (std::map<unsigned, int>{{200, 1}, {412, 5}}));
  }
}

TEST_F(ModelOrders, AFaultOfTheFileIsNotOneOfTheKey) {
  const std::string id = publish(mesh_);
  const Sha256 name = server_.catalogue().find(*ModelId::parse(id)).value().value().file;
  const std::string hex = to_hex(name);
  std::fstream(server_.data() / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex,
               std::ios::in | std::ios::out | std::ios::binary)
      .seekp(-9, std::ios::end)
      .write("damaged", 7);
  const HttpAnswer answer = ask("PATCH", "/models/" + id, operator_, {{"unit", "in"}});
  EXPECT_EQ(answer.status, 409) << answer.body;
  EXPECT_FALSE(json::parse(answer.body).contains("errors"));
  EXPECT_THAT(answer.body, HasSubstr(hex + " is damaged; publish it again"));
}

TEST_F(ModelOrders, WhatIsPublicOfAModelHasToFitIntoTheQuota) {
  const std::string id = publish(mesh_);
  for (int i = 0; i < 3; ++i) {
    const std::string size = std::to_string(i < 2 ? 1 << 20 : (1 << 20) - 100'000);
    EXPECT_EQ(send("POST", "/uploads",
                   operator_ + "Tus-Resumable: 1.0.0\r\nUpload-Length: " + size + "\r\n", "")
                  .status,
              201);
  }
  std::size_t filled = 0;  // number of bytes in use, read from the error message
  const HttpAnswer full = send(
      "POST", "/uploads",
      server_.bearer(Role::kOperator) + "Tus-Resumable: 1.0.0\r\nUpload-Length: 1000000\r\n", "");
  EXPECT_EQ(full.status, 507);
  EXPECT_THAT(full.body, HasSubstr(" of 3145728 bytes are taken; delete models or uploads"));
  std::sscanf(json::parse(full.body)["detail"].get<std::string>().c_str(),
              "1000000 bytes do not fit: %zu", &filled);
  EXPECT_EQ(send("POST", "/uploads",
                 server_.bearer(Role::kOperator) + "Tus-Resumable: 1.0.0\r\nUpload-Length: " +
                     std::to_string((3 << 20) - filled) + "\r\n",
                 "")
                .status,
            201);
  const HttpAnswer answer = ask("PATCH", "/models/" + id, operator_, {{"public_max_level", 0}});
  EXPECT_EQ(answer.status, 507) << answer.body;
  EXPECT_THAT(json::parse(answer.body)["detail"].get<std::string>(),
              HasSubstr("3145728 of 3145728 bytes are taken"));
  EXPECT_EQ(model(id)["public_max_level"], nullptr);
}

TEST_F(ModelOrders, AnUploadThatAJobWaitsForIsNotDeleted) {
  std::promise<void> go;
  server_.scans().jobs().executor("").post([waits = go.get_future().share()] { waits.wait(); });
  const std::string id = upload(mesh_);
  const HttpAnswer order = ask("POST", "/models", operator_, {{"upload", id}});
  const std::string job = json::parse(order.body)["job"];
  const auto remove = [&] {
    return send("DELETE", "/uploads/" + id, operator_ + "Tus-Resumable: 1.0.0\r\n", "");
  };
  const HttpAnswer refused = remove();
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.body, HasSubstr("job " + job + " needs the upload"));
  EXPECT_EQ(ask("DELETE", "/jobs/" + job, operator_).status, 202);
  EXPECT_EQ(remove().status, 204);
  go.set_value();
  settle();
}

TEST_F(ModelOrders, AnotherUnitIsInTheFileToo) {
  const std::string id = publish(mesh_);
  const HttpAnswer changed = ask("PATCH", "/models/" + id, operator_, {{"unit", "in"}});
  EXPECT_EQ(changed.status, 200);
  EXPECT_EQ(json::parse(changed.body)["dimensions"], model(id)["dimensions"]);
  EXPECT_EQ(model(id)["dimensions"]["unit"], "in");
  EXPECT_EQ(model(id)["unit"], "in");
  const json manifest = json::parse(ask("GET", "/models/" + id + "/manifest", "").body);
  EXPECT_EQ(manifest["unit"], "in");
  const std::string file = ask("GET", "/models/" + id + "/file.pmesh", "").body;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
  EXPECT_EQ(parse_header({bytes, file.size()}).value().unit, "in");
  EXPECT_EQ(ask("GET", "/models/" + id + "/export.ply", "").status, 200);
}

TEST_F(ModelOrders, VisitorsSeeNoMoreThanThePublicLevel) {
  const std::string id = publish(ply_of(test::torus(80, 60))), path = "/models/" + id;
  const json whole = json::parse(ask("GET", path + "/manifest", "").body);
  ASSERT_GE(whole["levels"].size(), 3u);
  const json fine = whole["chunks"].back(), coarse = whole["chunks"].front();
  const auto chunk = [](const json& c) { return "/chunks/" + c["sha256"].get<std::string>(); };
  EXPECT_EQ(ask("GET", chunk(fine), "").status, 200);
  for (int twice = 0; twice < 2; ++twice)
    EXPECT_EQ(ask("PATCH", path, operator_, {{"public_max_level", 1}}).status, 200);

  const json capped = json::parse(ask("GET", path + "/manifest", "").body);
  EXPECT_EQ(capped["levels"].size(), 2u);
  EXPECT_EQ(capped["levels"][1]["faces"], whole["levels"][1]["faces"]);
  EXPECT_EQ(model(id)["faces"], whole["levels"][1]["faces"]);
  EXPECT_EQ(model(id)["public_max_level"], 1);
  EXPECT_EQ(ask("GET", chunk(fine), "").status, 404);
  EXPECT_EQ(ask("GET", path + chunk(fine), "").status, 404);
  EXPECT_EQ(ask("GET", chunk(coarse), "").status, 200);
  const std::string file = ask("GET", path + "/file.pmesh", "").body;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
  const Manifest header = parse_header({bytes, file.size()}).value();
  EXPECT_EQ(header.levels.size(), 2u);
  EXPECT_EQ(header.file_bytes, file.size());
  const std::string ply = ask("GET", path + "/export.ply?level=highest", "").body;
  EXPECT_THAT(ply, HasSubstr("element face " + whole["levels"][1]["faces"].dump()));
  const json listed = json::parse(ask("GET", "/models", "").body);
  EXPECT_EQ(listed["models"][0]["faces"], whole["levels"][1]["faces"]);

  const HttpAnswer all = ask("GET", path + "/manifest", operator_);
  EXPECT_EQ(json::parse(all.body)["levels"], whole["levels"]);
  EXPECT_EQ(all.field("cache-control"), "private, no-store");
  const HttpAnswer own = ask("GET", path + chunk(fine), operator_);
  EXPECT_EQ(own.status, 200);
  EXPECT_EQ(own.field("cache-control"), "private, no-store");
  EXPECT_EQ(model(id, operator_)["faces"], whole["levels"].back()["faces"]);

  // The limit also applies to a replacement of the model. The value null removes the limit.
  EXPECT_EQ(publish(ply_of(test::torus(80, 50)), {{"replace", id}}), id);
  EXPECT_EQ(json::parse(ask("GET", path + "/manifest", "").body)["levels"].size(), 2u);
  EXPECT_EQ(ask("PATCH", path, operator_, {{"public_max_level", nullptr}}).status, 200);
  EXPECT_GT(json::parse(ask("GET", path + "/manifest", "").body)["levels"].size(), 2u);
}

TEST_F(ModelOrders, PostersAreMadeWhenVisitorsSeeAnotherFile) {
  constexpr std::uint64_t kWidths = 3;
  server_.services().exports.set_capacity(10'000'000);
  server_.services().order_posters = [this](const ModelId& model) {
    make_posters(model, server_.services());
  };
  const std::string id = publish(ply_of(test::torus(80, 60)), {{"publish", false}});
  const std::string path = "/models/" + id;
  const auto& made = server_.services().exports.made;
  EXPECT_EQ(made, 0u);
  EXPECT_EQ(ask("POST", path + "/publish", operator_).status, 200);
  EXPECT_EQ(made, kWidths);
  EXPECT_EQ(ask("PATCH", path, operator_, {{"title", "Ring"}}).status, 200);
  EXPECT_EQ(made, kWidths);
  EXPECT_EQ(ask("PATCH", path, operator_, {{"public_max_level", 1}}).status, 200);
  EXPECT_EQ(made, 2 * kWidths);
  EXPECT_EQ(ask("GET", path + "/poster.png", "").status, 200);
  EXPECT_EQ(made, 2 * kWidths) << "no visitor waits";
}

TEST_F(ModelOrders, AModelThatIsDeletedIsGoneWithItsBytes) {
  const std::string id = publish(mesh_), path = "/models/" + id;
  const std::string kept = publish(ply_of(test::torus(30, 20)));
  EXPECT_EQ(ask("DELETE", path, operator_).status, 204);
  EXPECT_EQ(ask("GET", path, "").status, 404);
  EXPECT_EQ(ask("GET", path, operator_).status, 404);
  EXPECT_EQ(ask("DELETE", path, operator_).status, 404);
  EXPECT_EQ(server_.collector().collect().value().objects, 1u);
  EXPECT_EQ(objects(), 1u);
  EXPECT_EQ(ask("GET", "/models/" + kept + "/file.pmesh", "").status, 200);
}

TEST_F(ModelOrders, ACollectionLeavesWhatAJobWillNeed) {
  const std::string waits = upload(mesh_);
  JobRecord job = PublishJobs::job_for({.upload = *UploadId::parse(waits)}, TokenId());
  ASSERT_TRUE(server_.jobs().add(job, std::nullopt, std::nullopt));
  const auto late = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(server_.collector().collect(late).value().uploads, 0u);
  job.state = JobState::kCancelled;
  ASSERT_TRUE(server_.jobs().update(job));
  EXPECT_EQ(server_.collector().collect(late).value().uploads, 1u);
}

TEST_F(ModelOrders, TokensAreListedInPages) {
  const std::string admin = server_.bearer(Role::kAdmin);
  std::vector<std::string> made, listed;
  for (int i = 0; i < 4; ++i)
    server_.bearer(Role::kViewer);
  const auto tokens = server_.catalogue().tokens().value();
  for (const TokenRecord& token : tokens)
    made.push_back(token.id.to_string());
  std::string cursor;
  do {
    const json page = json::parse(ask("GET", "/tokens?limit=2" + cursor, admin).body);
    EXPECT_LE(page["tokens"].size(), 2u);
    for (const json& token : page["tokens"])
      listed.push_back(token["id"]);
    cursor = page["next"].is_null() ? "" : "&cursor=" + page["next"].get<std::string>();
  } while (!cursor.empty());
  EXPECT_EQ(listed, made);
  EXPECT_EQ(ask("GET", "/tokens?limit=0", admin).status, 400);
}

TEST_F(ModelOrders, TokensAreMadeListedAndRevokedByAdministrators) {
  const std::string admin = server_.bearer(Role::kAdmin);
  const HttpAnswer made = ask("POST", "/tokens", admin, {{"role", "operator"}, {"label", "Anna"}});
  ASSERT_EQ(made.status, 201) << made.body;
  const json token = json::parse(made.body);
  const std::string bearer = "Authorization: Bearer " + token["token"].get<std::string>() + "\r\n";
  EXPECT_EQ(ask("GET", "/jobs", bearer).status, 200);
  EXPECT_EQ(ask("GET", "/tokens", bearer).status, 403);
  const HttpAnswer listed = ask("GET", "/tokens", admin);
  EXPECT_THAT(listed.body, HasSubstr("Anna"));
  EXPECT_THAT(listed.body, Not(HasSubstr("vtr_")));
  const std::string path = "/tokens/" + token["id"].get<std::string>();
  EXPECT_EQ(ask("DELETE", path, admin).status, 204);
  EXPECT_EQ(ask("DELETE", path, admin).status, 404);
  EXPECT_EQ(ask("GET", "/jobs", bearer).status, 401);
  EXPECT_EQ(fault_of(ask("POST", "/tokens", admin, {{"role", "king"}})), "role");
}

}  // namespace
}  // namespace vitrine::server
