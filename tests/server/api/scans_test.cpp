// SPDX-License-Identifier: Apache-2.0
// Tests scanners, calibrations, scans and jobs over HTTP. The scanner is simulated, without devices
// (fake_backend.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <future>
#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "support/fake_backend.h"
#include "support/local_server.h"
#include "support/process/http_client.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::FakeScanner;
using test::HeldAtStep;
using test::HttpAnswer;
using test::HttpClient;
using test::LocalServer;

class ScanRoutes : public testing::Test {
 protected:
  ScanRoutes() { EXPECT_TRUE(server_.scans().start()); }

  static std::vector<std::unique_ptr<ScannerBackend>> one(FakeScanner& world) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world));
    return backends;
  }
  HttpAnswer ask(const std::string& method, const std::string& path, const std::string& who,
                 const json& body = nullptr, const std::string& fields = "") {
    const std::string text = body.is_null() ? "" : body.dump();
    const std::string about = text.empty() ? "" : "Content-Type: application/json\r\n";
    HttpClient client(server_.port());
    client.send(method + " /api/v1" + path + " HTTP/1.1\r\nHost: a\r\n" + who + fields + about +
                "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text);
    return client.receive();
  }
  HttpAnswer get(const std::string& path) { return ask("GET", path, viewer_); }
  HttpAnswer post(const std::string& path, const json& body = nullptr,
                  const std::string& fields = "") {
    return ask("POST", path, operator_, body, fields);
  }
  json begin(const json& more = json::object()) {
    json body = {{"scanner", "rig"}, {"steps", 12}};
    body.update(more);
    const HttpAnswer answer = post("/scans", body);
    EXPECT_EQ(answer.status, 202) << answer.body;
    const json started = json::parse(answer.body);
    EXPECT_EQ(answer.field("location"), "/api/v1/jobs/" + started["job"].get<std::string>());
    return started;
  }
  static std::string scan_path(const json& started) {
    return "/scans/" + started["id"].get<std::string>();
  }
  static std::string job_path(const json& started) {
    return "/jobs/" + started["job"].get<std::string>();
  }
  // Returns once all earlier tasks of the scanner are done.
  void settle(const std::string& scanner = "rig") {
    server_.scans().jobs().executor(scanner).run([] {});
  }

  // Returns the next event of the stream. Skips comments.
  static std::string next_event(HttpClient& client) {
    std::string event;
    while (!event.ends_with("\n\n") || event.starts_with(":")) {
      if (event.ends_with("\n\n")) event.clear();
      event += client.read_exactly(1);
    }
    return event;
  }
  static std::string fault_of(const HttpAnswer& answer) {
    return json::parse(answer.body)["errors"].at(0)["parameter"];
  }

  FakeScanner world_;
  LocalServer server_{public_routes(), std::chrono::seconds(30), one(world_)};
  const std::string viewer_ = server_.bearer(Role::kViewer);
  const std::string operator_ = server_.bearer(Role::kOperator);
};

TEST_F(ScanRoutes, ScannersAreListedAndShownWithTheirDevices) {
  const json listed = json::parse(get("/scanners").body);
  ASSERT_EQ(listed["scanners"].size(), 1u);
  json shown = json::parse(get("/scanners/rig").body);
  EXPECT_EQ(listed["scanners"][0], shown);
  EXPECT_EQ(shown["laser"]["state"], "off");
  EXPECT_EQ(shown["motor"]["state"], "off");
  shown.erase("laser");
  shown.erase("motor");
  EXPECT_EQ(shown, json::parse(R"({"id":"rig","name":"rig","state":"idle",
    "camera":{"vendor":"Acme","model":"C1","serial":"42"},
    "board":{"dialect":"horus","firmware":"fake 1.0"},
    "calibration":1,"scan":null,"problem":null})"));
  EXPECT_EQ(get("/scanners/other").status, 404);
}

TEST_F(ScanRoutes, CommandsAreForOperators) {
  for (const std::string path : {"/scanners/rig/jog", "/scanners/rig/laser", "/scanners/rig/stop",
                                 "/scanners/rig/calibrations", "/scans"}) {
    EXPECT_EQ(ask("POST", path, "", json::object()).status, 401) << path;
    EXPECT_EQ(ask("POST", path, viewer_, json::object()).status, 403) << path;
  }
  EXPECT_EQ(ask("GET", "/scanners", "").status, 401);
  EXPECT_EQ(ask("GET", "/scans", "").status, 401);
  EXPECT_EQ(ask("GET", "/jobs", "").status, 401);
  EXPECT_EQ(get("/scanners/rig/preview").status, 403);
  EXPECT_EQ(world_.degrees, 0);
}

TEST_F(ScanRoutes, JogLaserAndStopReachTheDevices) {
  EXPECT_EQ(post("/scanners/rig/jog", {{"degrees", -12.5}}).status, 200);
  EXPECT_EQ(world_.degrees, -12.5);
  EXPECT_EQ(post("/scanners/rig/laser", {{"on", true}}).status, 200);
  EXPECT_TRUE(world_.laser);
  const HttpAnswer stopped = post("/scanners/rig/stop");
  EXPECT_EQ(stopped.status, 200);
  EXPECT_EQ(json::parse(stopped.body)["name"], "rig");
  EXPECT_TRUE(world_.stopped());
  EXPECT_FALSE(world_.laser);
  world_.reachable = false;
  const HttpAnswer lost = post("/scanners/rig/jog", {{"degrees", 1}});
  EXPECT_EQ(lost.status, 409);
  EXPECT_NE(lost.body.find("check its cable"), std::string::npos);
  EXPECT_EQ(json::parse(get("/scanners/rig").body)["state"], "unreachable");
}

TEST_F(ScanRoutes, AWrongCommandNamesItsField) {
  for (const json& body : {json::object(), json{{"degrees", "10"}}, json{{"degrees", 1e9}},
                           json{{"degrees", 1}, {"fast", true}}}) {
    const HttpAnswer answer = post("/scanners/rig/jog", body);
    EXPECT_EQ(answer.status, 422) << body;
    EXPECT_EQ(fault_of(answer), "degrees");
  }
  EXPECT_EQ(fault_of(post("/scanners/rig/laser", {{"on", 1}})), "on");
  EXPECT_EQ(fault_of(post("/scanners/rig/calibrations", {{"poses", 1}})), "poses");
  EXPECT_EQ(fault_of(post("/scans", {{"scanner", "rig"}, {"steps", 1}})), "steps");
  EXPECT_EQ(fault_of(post("/scans", {{"scanner", "other"}})), "scanner");
  EXPECT_EQ(fault_of(post("/scans", {{"scanner", "rig"}},
                          "Idempotency-Key: " + std::string(300, 'a') + "\r\n")),
            "Idempotency-Key");
}

TEST_F(ScanRoutes, ThePreviewIsAPicture) {
  const HttpAnswer answer = ask("GET", "/scanners/rig/preview", operator_);
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.field("content-type"), "image/png");
  EXPECT_EQ(answer.body.substr(1, 3), "PNG");
}

TEST_F(ScanRoutes, CalibrationsAreListedShownAndMadeByAJob) {
  const HttpAnswer answer = post("/scanners/rig/calibrations");
  EXPECT_EQ(answer.status, 202);
  settle();
  const json job =
      json::parse(get("/jobs/" + json::parse(answer.body)["job"].get<std::string>()).body);
  EXPECT_EQ(job["kind"], "calibrate");
  EXPECT_EQ(job["state"], "done");
  const json all = json::parse(get("/scanners/rig/calibrations").body)["calibrations"];
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["number"], 2);
  EXPECT_EQ(all[0]["region"]["width"], 64);
  EXPECT_EQ(all[0]["rms"], 0.02);
  EXPECT_EQ(all[0]["coverage"], 0.8);
  EXPECT_EQ(json::parse(get("/scanners/rig/calibrations/2").body)["number"], 2);
  EXPECT_EQ(get("/scanners/rig/calibrations/3").status, 404);
  EXPECT_EQ(get("/scanners/rig/calibrations/2/residuals.svg").field("content-type"),
            "image/svg+xml");
}

TEST_F(ScanRoutes, ACalibrationByHandWaitsForWhoPlacesTheTarget) {
  world_.is_placed_by_hand = true;
  const json started = json::parse(post("/scanners/rig/calibrations", {{"poses", 3}}).body);
  for (int pose = 1; pose <= 3; ++pose) {
    const std::string stage = "place the target, pose " + std::to_string(pose);
    json job;
    do
      job = json::parse(get(job_path(started)).body);
    while (job["stage"] != stage || job["state"] != "paused");
    EXPECT_EQ(job["note"], "so far it is seen");
    EXPECT_EQ(ask("POST", job_path(started) + "/resume", viewer_).status, 403);
    EXPECT_EQ(post(job_path(started) + "/resume").status, 202);
  }
  settle();
  EXPECT_EQ(json::parse(get(job_path(started)).body)["state"], "done");
  EXPECT_EQ(post(job_path(started) + "/resume").status, 409);
}

TEST_F(ScanRoutes, ADamagedCalibrationIsNamedBesideTheOthers) {
  world_.damaged = 9;
  const json answer = json::parse(get("/scanners/rig/calibrations").body);
  EXPECT_EQ(answer["calibrations"].size(), 1u);
  EXPECT_EQ(answer["damaged"],
            json::parse(R"([{"number":9,"problem":"0009.json is cut short; remove it"}])"));
}

TEST_F(ScanRoutes, PointsWhoseFolderIsGoneAreAConflictThatNamesIt) {
  const json started = begin();
  settle();
  std::filesystem::remove_all(server_.data() / "scans");
  const HttpAnswer answer = get(scan_path(started) + "/points");
  EXPECT_EQ(answer.status, 409);
  EXPECT_NE(answer.body.find("scans/" + started["id"].get<std::string>()), std::string::npos);
  EXPECT_EQ(get(scan_path(started) + "/profile").status, 409);
}

TEST_F(ScanRoutes, AScanWhoseModelIsHiddenIsHiddenToo) {
  const json started = begin({{"publish", true}, {"metadata", {{"title", "A bust"}}}});
  settle();
  const json scan = json::parse(get(scan_path(started)).body);
  const std::string model = "/models/" + scan["model"].get<std::string>();
  const auto expect = [&](unsigned status) {
    for (const std::string& path : {scan_path(started), scan_path(started) + "/points",
                                    scan_path(started) + "/profile", job_path(started)})
      EXPECT_EQ(ask("GET", path, "").status, status) << path;
  };
  expect(200);
  for (const std::string& path : {scan_path(started), job_path(started)}) {
    EXPECT_EQ(ask("GET", path, "").field("cache-control"), "no-store");
    EXPECT_EQ(get(path).field("cache-control"), "private, no-store") << "as its caller sees it";
  }
  EXPECT_EQ(post(model + "/unpublish").status, 200);
  expect(401);
  EXPECT_EQ(post(model + "/publish").status, 200);
  expect(200);
}

TEST_F(ScanRoutes, AScanIsSeenToGrowAndEndsAsADraft) {
  HeldAtStep held(world_, 5);
  const json started = begin({{"metadata", {{"title", "A ring"}}}});
  held.await();
  json scan = json::parse(get(scan_path(started)).body);
  EXPECT_EQ(scan["state"], "scanning");
  EXPECT_EQ(scan["step"], 5);
  EXPECT_EQ(scan["steps"], 12);
  EXPECT_EQ(scan["title"], "A ring");
  EXPECT_EQ(scan["points"], 50);
  EXPECT_EQ(scan["rows"], nullptr);
  EXPECT_EQ(json::parse(get("/scanners/rig").body)["scan"], started["id"]);
  const HttpAnswer points = get(scan_path(started) + "/points?from=48");
  ASSERT_EQ(points.body.size(), 2 * 12u);
  float first[3];
  std::memcpy(first, points.body.data(), sizeof first);
  EXPECT_EQ(first[0], 4);
  EXPECT_EQ(first[1], 8);
  EXPECT_EQ(get(scan_path(started) + "/points?from=50").body, "");
  for (const std::string wrong : {"from=x", "form=1", "from=%"})
    EXPECT_EQ(get(scan_path(started) + "/points?" + wrong).status, 400) << wrong;
  EXPECT_EQ(json::parse(get(scan_path(started) + "/profile").body),
            json::parse("[[12.5,3],[12.25,4]]"));
  held.open();
  settle();
  scan = json::parse(get(scan_path(started)).body);
  EXPECT_EQ(scan["state"], "done") << scan;
  EXPECT_EQ(scan["progress"], 1);
  EXPECT_EQ(scan["rows"], json::parse(R"({"empty":0.5,"saturated":0.25,"doubled":0.125})"));
  ASSERT_TRUE(scan["model"].is_string());
  const std::string model = "/models/" + scan["model"].get<std::string>();
  EXPECT_EQ(ask("GET", model + "/export.ply", "").status, 404);
  const HttpAnswer exported = get(model + "/export.ply?level=lowest");
  EXPECT_EQ(exported.status, 200) << exported.body;
  EXPECT_EQ(exported.field("cache-control"), "private, no-store");
  EXPECT_EQ(get(scan_path(started) + "/points").body.size(), 12 * 10 * 12u);
}

TEST_F(ScanRoutes, WhatAScanWaitsForIsToldUntilItGoesOn) {
  world_.note = "camera 42 is gone; check its cable";
  HeldAtStep held(world_, 5);
  const json started = begin();
  held.await();
  EXPECT_EQ(json::parse(get(scan_path(started)).body)["note"], world_.note);
  EXPECT_EQ(json::parse(get(job_path(started)).body)["note"], world_.note);
  held.open();
  settle();
  EXPECT_EQ(json::parse(get(scan_path(started)).body)["note"], nullptr);
  EXPECT_EQ(json::parse(get(job_path(started)).body)["note"], nullptr);
}

TEST_F(ScanRoutes, APublicScanIsSeenByEverybodyAndBecomesAModel) {
  const json started = begin({{"publish", true}});
  const json other = [&] {
    settle();
    return begin();
  }();
  settle();
  const HttpAnswer answer = ask("GET", scan_path(started), "");
  ASSERT_EQ(answer.status, 200);
  const std::string model = json::parse(answer.body)["model"];
  EXPECT_EQ(ask("GET", "/models/" + model, "").status, 200);
  EXPECT_EQ(ask("GET", scan_path(started) + "/points", "").status, 200);
  EXPECT_EQ(ask("GET", job_path(started), "").status, 200);
  for (const std::string& path : {scan_path(other), scan_path(other) + "/points", job_path(other)})
    EXPECT_EQ(ask("GET", path, "").status, 401) << path;
}

TEST_F(ScanRoutes, WhatTheScannerOrTheStateDoesNotAllowIsAConflict) {
  HeldAtStep held(world_, 3);
  const json started = begin();
  held.await();
  EXPECT_EQ(post("/scans", {{"scanner", "rig"}}).status, 409);
  EXPECT_EQ(post("/scanners/rig/calibrations").status, 409);
  EXPECT_EQ(post("/scanners/rig/jog", {{"degrees", 1}}).status, 409);
  EXPECT_EQ(post("/scanners/rig/laser", {{"on", true}}).status, 409);
  EXPECT_EQ(post(scan_path(started) + "/resume").status, 409);
  EXPECT_EQ(post(scan_path(started) + "/reprocess").status, 409);
  held.open();
  settle();
  EXPECT_EQ(post(scan_path(started) + "/pause").status, 409);
  EXPECT_EQ(ask("DELETE", job_path(started), operator_).status, 409);
  EXPECT_EQ(fault_of(post(scan_path(started) + "/reprocess", {{"steps", 5}})), "steps");
}

TEST_F(ScanRoutes, WithoutPicturesOtherPointsAreAConflictAtOnce) {
  const json started = begin();
  settle();
  const HttpAnswer answer = post(scan_path(started) + "/reprocess", {{"stripe", "blais-rioux"}});
  EXPECT_EQ(answer.status, 409);
  EXPECT_EQ(answer.field("content-type"), "application/problem+json");
  EXPECT_NE(answer.body.find("which were not kept; scan again"), std::string::npos);
  EXPECT_EQ(json::parse(get("/jobs").body)["jobs"].size(), 1u);
  const json same = {{"stripe", "derivative-of-gaussian"}, {"calibration", 1}};
  EXPECT_EQ(post(scan_path(started) + "/reprocess", same).status, 202);
  settle("");
}

TEST_F(ScanRoutes, AScanIsPausedResumedCancelledAndReprocessed) {
  HeldAtStep held(world_, 3);
  const json started = begin({{"keep_frames", true}});
  held.await();
  EXPECT_EQ(post(scan_path(started) + "/pause").status, 202);
  held.open();
  settle();
  EXPECT_EQ(json::parse(get(scan_path(started)).body)["state"], "paused");
  HeldAtStep again(world_, 6);
  EXPECT_EQ(post(scan_path(started) + "/resume").status, 202);
  again.await();
  EXPECT_EQ(ask("DELETE", job_path(started), viewer_).status, 403);
  EXPECT_EQ(ask("DELETE", job_path(started), operator_).status, 202);
  again.open();
  settle();
  const json scan = json::parse(get(scan_path(started)).body);
  EXPECT_EQ(scan["state"], "cancelled");
  EXPECT_EQ(scan["step"], 6);
  EXPECT_EQ(fault_of(post(scan_path(started) + "/reprocess", {{"length", 7}})), "length");
  const HttpAnswer reprocessed =
      post(scan_path(started) + "/reprocess",
           {{"length", 20}, {"stripe", "blais-rioux"}, {"largest_hole", 9}, {"calibration", 1}});
  EXPECT_EQ(reprocessed.status, 202) << reprocessed.body;
  settle("");
  const auto& [stripe, sampling, surface] = world_.rebuilt.request.processing;
  EXPECT_EQ(stripe.method, acquisition::StripeMethod::kBlaisRioux);
  EXPECT_EQ(sampling.window, 20);
  EXPECT_EQ(surface.largest_hole, 9);
  EXPECT_EQ(world_.rebuilt.calibration, 1);
  EXPECT_TRUE(json::parse(get(scan_path(started)).body)["model"].is_string());
}

TEST_F(ScanRoutes, AKeyMakesARequestHaveItsEffectOnce) {
  HeldAtStep held(world_, 1);
  const std::string key = "Idempotency-Key: abc\r\n";
  const json body = {{"scanner", "rig"}, {"steps", 12}};
  const HttpAnswer first = post("/scans", body, key), second = post("/scans", body, key);
  EXPECT_EQ(first.status, 202);
  EXPECT_EQ(second.status, 202);
  EXPECT_EQ(first.body, second.body);
  const HttpAnswer other = post("/scans", {{"scanner", "rig"}, {"steps", 13}}, key);
  EXPECT_EQ(other.status, 422);
  EXPECT_EQ(fault_of(other), "Idempotency-Key");
  EXPECT_EQ(json::parse(get("/scans").body)["scans"].size(), 1u);
  held.open();
  settle();
  const std::string again = scan_path(json::parse(first.body)) + "/reprocess";
  const std::string other_key = "Idempotency-Key: abd\r\n";
  std::promise<void> go;
  server_.scans().jobs().executor("").post([gone = go.get_future().share()] { gone.wait(); });
  const HttpAnswer begun = post(again, {{"length", 20}}, other_key);
  EXPECT_EQ(begun.status, 202);
  EXPECT_EQ(post(again, {{"length", 20}}, other_key).body, begun.body) << "while it is under way";
  go.set_value();
  settle("");
}

TEST_F(ScanRoutes, TheEndOfACalibrationIsToldToHostsThatAreNamedAlone) {
  const auto calibrate = [&](const std::string& webhook) {
    return post("/scanners/rig/calibrations", {{"poses", 3}, {"webhook", webhook}});
  };
  EXPECT_EQ(fault_of(calibrate("http://elsewhere.example/")), "webhook");
  const HttpAnswer begun = calibrate("http://127.0.0.1/");
  ASSERT_EQ(begun.status, 202) << begun.body;
  const auto job = JobId::parse(json::parse(begun.body)["job"].get<std::string>());
  EXPECT_EQ(server_.jobs().find_job(*job).value()->webhook, "http://127.0.0.1/");
  settle();
}

TEST_F(ScanRoutes, EventsTellAJobToItsEnd) {
  HeldAtStep held(world_, 3);
  const json started = begin();
  held.await();
  HttpClient client(server_.port());
  client.send("GET /api/v1" + job_path(started) + "/events HTTP/1.1\r\nHost: a\r\n" + viewer_ +
              "\r\n");
  EXPECT_EQ(client.receive().field("content-type"), "text/event-stream");
  std::string state;
  while (state != "done") {
    const std::string event = next_event(client);
    ASSERT_TRUE(event.starts_with("event: job\nid: ")) << event;
    const json job = json::parse(event.substr(event.find('{')));
    if (state.empty()) {
      EXPECT_EQ(job["state"], "running");
      held.open();
    }
    state = job["state"];
    ASSERT_NE(state, "failed") << event;
  }
  EXPECT_TRUE(client.is_closed());
}

TEST_F(ScanRoutes, WhatIsNotThereIsNotFound) {
  const std::string id = ModelId::generate().to_string();
  for (const std::string& path :
       {"/scans/" + id, "/scans/" + id + "/points", "/jobs/" + id, "/jobs/" + id + "/events"})
    EXPECT_EQ(get(path).status, 404) << path;
  EXPECT_EQ(post("/scans/" + id + "/pause").status, 404);
  EXPECT_EQ(ask("DELETE", "/jobs/" + id, operator_).status, 404);
  for (const std::string wrong : {"limit=0", "limits=1", "from=%"})
    EXPECT_EQ(get("/jobs?" + wrong).status, 400) << wrong;
}

TEST_F(ScanRoutes, AStopIsObeyedWhateverItsBodyIs) {
  const std::pair<std::string, std::string> bodies[] = {
      {"application/json", "{garbage"},
      {"application/x-www-form-urlencoded", "press=1"},
      {"application/octet-stream", std::string(3 << 20, 'x')}};
  for (const auto& [type, body] : bodies) {
    const auto before = world_.stops.load();
    HttpClient client(server_.port());
    client.send("POST /api/v1/scanners/rig/stop HTTP/1.1\r\nHost: a\r\n" + operator_ +
                "Content-Type: " + type + "\r\nContent-Length: " + std::to_string(body.size()) +
                "\r\n\r\n" + body);
    EXPECT_EQ(client.receive().status, 200) << type;
    EXPECT_EQ(world_.stops, before + 1) << type;
  }
}

TEST_F(ScanRoutes, AStopsBodyIsNotTakenForTheNextRequest) {
  const std::string hidden = "POST /api/v1/scanners/rig/jog HTTP/1.1\r\nHost: a\r\n" + operator_ +
                             "Content-Type: application/json\r\nContent-Length: 14\r\n\r\n"
                             R"({"degrees": 9})";
  const std::string length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n";
  for (const std::string& framing :
       {length, std::string("Transfer-Encoding: chunked\r\n"), length + "Expect: 100-continue\r\n",
        std::string("Transfer-Encoding: chunked\r\nExpect: 100-continue\r\n")}) {
    const auto before = world_.stops.load();
    HttpClient client(server_.port());
    client.send("POST /api/v1/scanners/rig/stop HTTP/1.1\r\nHost: a\r\n" + operator_ + framing +
                "\r\n" + hidden);
    const HttpAnswer answer = client.receive();
    EXPECT_EQ(answer.status, 200) << framing;
    EXPECT_EQ(answer.field("connection"), "close") << framing;
    EXPECT_TRUE(client.is_closed()) << framing;
    EXPECT_EQ(world_.stops, before + 1) << framing;
    EXPECT_EQ(world_.degrees, 0) << framing;
  }
}

TEST_F(ScanRoutes, AScanIsShownOnceItsDraftIsPublished) {
  const json started = begin();
  settle();
  EXPECT_EQ(ask("GET", scan_path(started), "").status, 401);
  const std::string model = json::parse(get(scan_path(started)).body)["model"];
  EXPECT_EQ(post("/models/" + model + "/publish").status, 200);
  for (const std::string& path : {scan_path(started), scan_path(started) + "/points"})
    EXPECT_EQ(ask("GET", path, "").status, 200) << path;
}

TEST_F(ScanRoutes, AModelOfHalfAnObjectIsPublicWhereThatIsSaidAnew) {
  HeldAtStep held(world_, 3);
  const json started = begin({{"publish", true}});
  held.await();
  EXPECT_EQ(ask("DELETE", job_path(started), operator_).status, 202);
  held.open();
  settle();
  EXPECT_EQ(post(scan_path(started) + "/reprocess").status, 202);
  settle("");
  EXPECT_FALSE(world_.rebuilt.is_public);
  EXPECT_EQ(post(scan_path(started) + "/reprocess", {{"publish", true}}).status, 202);
  settle("");
  EXPECT_TRUE(world_.rebuilt.is_public);
}

TEST_F(ScanRoutes, ACancelledScanIsHidden) {
  HeldAtStep held(world_, 3);
  const json started = begin({{"publish", true}});
  held.await();
  EXPECT_EQ(ask("GET", scan_path(started) + "/points", "").status, 200);
  EXPECT_EQ(ask("DELETE", job_path(started), operator_).status, 202);
  held.open();
  settle();
  for (const char* part : {"", "/points", "/profile"})
    EXPECT_EQ(ask("GET", scan_path(started) + part, "").status, 401) << part;
}

TEST_F(ScanRoutes, WhatIsNoIdIsNotFoundWhateverTheMethod) {
  EXPECT_EQ(get("/scans/nonsense").status, 404);
  EXPECT_EQ(post("/scans/nonsense/pause").status, 404);
  EXPECT_EQ(post("/scans/" + ModelId::generate().to_string() + "/nonsense").status, 404);
  EXPECT_EQ(ask("DELETE", "/jobs/nonsense", operator_).status, 404);
}

TEST_F(ScanRoutes, WhatNeedsACalibrationThatIsNotThereIsRefusedAtOnce) {
  const json started = begin();
  settle();
  const HttpAnswer unknown = post(scan_path(started) + "/reprocess", {{"calibration", 7}});
  EXPECT_EQ(unknown.status, 422);
  EXPECT_EQ(fault_of(unknown), "calibration");
  world_.calibrations = 0;
  world_.damaged = 9;
  const HttpAnswer refused = post("/scans", {{"scanner", "rig"}});
  EXPECT_EQ(refused.status, 409);
  EXPECT_NE(refused.body.find("/api/v1/scanners/rig/calibrations"), std::string::npos);
}

TEST_F(ScanRoutes, WhyAPublicScanFailsIsToldToCallersAlone) {
  const std::string path = "/srv/vitrine/calibrations";
  world_.note = path + " is gone; mount it";
  HeldAtStep held(world_, 3);
  world_.before_step = [this, hold = world_.before_step](int step) -> std::optional<Error> {
    hold(step);
    if (step < 3) return std::nullopt;
    return Error{ErrorCode::kIo, world_.note};
  };
  const json started = begin({{"publish", true}});
  held.await();
  const auto expect_told_to_callers = [&] {
    for (const std::string& what : {scan_path(started), job_path(started)}) {
      EXPECT_NE(get(what).body.find(path), std::string::npos) << what;
      const HttpAnswer seen = ask("GET", what, "");
      EXPECT_EQ(seen.status, 200) << what;
      EXPECT_EQ(seen.body.find(path), std::string::npos) << seen.body;
    }
  };
  expect_told_to_callers();
  HttpClient visitor(server_.port());
  visitor.send("GET /api/v1" + job_path(started) + "/events HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(visitor.receive().status, 200);
  std::string seen = next_event(visitor);
  EXPECT_NE(seen.find("waiting for the scanner"), std::string::npos) << seen;
  held.open();
  while (seen.find(R"("state":"failed")") == std::string::npos) {
    EXPECT_EQ(seen.find(path), std::string::npos) << seen;
    seen = next_event(visitor);
  }
  EXPECT_NE(seen.find("send a token to see why"), std::string::npos) << seen;
  settle();
  expect_told_to_callers();
  EXPECT_NE(json::parse(ask("GET", scan_path(started), "").body)["error"], nullptr);
  const HttpAnswer events = ask("GET", job_path(started) + "/events", "");
  EXPECT_EQ(events.body.find(path), std::string::npos) << events.body;
}

TEST_F(ScanRoutes, TimesAreTextAsThoseOfModelsAre) {
  HeldAtStep held(world_, 1);
  const json started = begin();
  held.await();
  const json running = json::parse(get(job_path(started)).body);
  EXPECT_EQ(running["ended"], nullptr);
  held.open();
  settle();
  const json scan = json::parse(get(scan_path(started)).body);
  const json job = json::parse(get(job_path(started)).body);
  for (const json& time : {scan["created"], job["created"], job["ended"]}) {
    ASSERT_TRUE(time.is_string()) << time;
    EXPECT_THAT(time.get<std::string>(), testing::MatchesRegex("20..-..-..T..:..:..[.]...Z"));
  }
}

TEST_F(ScanRoutes, ListsHavePages) {
  for (int i = 0; i < 3; ++i) {
    begin();
    settle();
  }
  const json first = json::parse(get("/jobs?limit=2").body);
  ASSERT_EQ(first["jobs"].size(), 2u);
  const json second =
      json::parse(get("/jobs?limit=2&cursor=" + first["next"].get<std::string>()).body);
  EXPECT_EQ(second["jobs"].size(), 1u);
  EXPECT_EQ(second["next"], nullptr);
  EXPECT_EQ(json::parse(get("/scans?limit=2").body)["scans"].size(), 2u);
}

}  // namespace
}  // namespace vitrine::server
