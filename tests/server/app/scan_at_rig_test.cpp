// SPDX-License-Identifier: Apache-2.0
// Tests a complete scan, from the calibration to a model that visitors can open. The daemon drives
// a scanner that vitrine-rig simulates, over the real protocols.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "acquisition/rig/private_network.h"
#include "codec/export/write_mesh.h"
#include "support/meshes.h"
#include "support/process/http_client.h"
#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/rig_operator.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

using nlohmann::json;

constexpr int kSteps = 48;

// Waits until `condition`, which depends on another process, is true. Throws after three minutes.
template <class Condition>
void wait_until(Condition condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(3);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) throw std::runtime_error("it did not come");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

class DaemonAtRig : public testing::Test {
 protected:
  // The camera's port is fixed, so tests that run side by side need private networks.
  static void SetUpTestSuite() { ASSERT_TRUE(rig::enter_private_network()); }

  // `options` are passed to vitrine-rig.
  explicit DaemonAtRig(std::vector<std::string> options = {}) : options_(std::move(options)) {
    const auto mesh = write_mesh(torus(60, 30), MeshFormat::kPly, {.unit = "mm"}).value();
    std::ofstream(path("object.ply"), std::ios::binary)
        .write(reinterpret_cast<const char*>(mesh.data()),
               static_cast<std::streamsize>(mesh.size()));
    std::filesystem::create_directory(path("data"));
    const ProgramResult made = run_program({VITRINE_BIN_DIR "/vitrine", "token", "create", "--role",
                                            "operator", "--data", path("data"), "--json"});
    token_ = json::parse(made.output)["token"];
    rig_ = std::thread([this] { result_ = run_program(words()); });
  }
  void SetUp() override { wait_for_port(); }
  ~DaemonAtRig() override {
    std::ofstream(path("end"));
    if (std::filesystem::exists(path("pid"))) signal_daemon(SIGTERM);
    rig_.join();
    EXPECT_EQ(result_.exit_code, 0) << result_.errors;
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  static std::string text(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  // Returns the command line of vitrine-rig. vitrine-rig runs the script below, which restarts the
  // daemon whenever it ends.
  std::vector<std::string> words() const {
    std::vector<std::string> all = {VITRINE_BIN_DIR "/vitrine-rig",
                                    "--mesh",
                                    path("object.ply"),
                                    "--height-mm",
                                    "40",
                                    "--steps",
                                    std::to_string(kSteps),
                                    "--write-config",
                                    path("rig.json")};
    all.insert(all.end(), options_.begin(), options_.end());
    all.insert(
        all.end(),
        {"--", "sh", "-c",
         "cd \"$0\" && while ! test -e end; do rm -f port; \"$1\" --listen 127.0.0.1:0 "
         "--port-file port --data data --scanners rig.json --access-log '' & echo $! > pid.new; "
         "mv pid.new pid; wait; done",
         folder_.path().string(), VITRINE_BIN_DIR "/vitrined"});
    return all;
  }

  void signal_daemon(int number) const { ::kill(std::stoi(text(path("pid"))), number); }
  void wait_for_port() {
    wait_until([this] { return !text(path("port")).empty(); });
  }
  void kill_daemon() {
    const std::string before = text(path("pid"));
    signal_daemon(SIGKILL);
    wait_until([&] { return text(path("pid")) != before; });
    wait_for_port();
  }

  HttpAnswer ask(const std::string& method, const std::string& target, const json& body = nullptr) {
    const std::string content = body.is_null() ? "" : body.dump();
    HttpClient client(static_cast<std::uint16_t>(std::stoi(text(path("port")))));
    client.send(
        fmt::format("{} /api/v1{} HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer {}\r\n"
                    "Content-Type: application/json\r\nContent-Length: {}\r\n\r\n{}",
                    method, target, token_, content.size(), content));
    return client.receive();
  }
  json get(const std::string& target) { return json::parse(ask("GET", target).body); }

  void calibrate() {
    const HttpAnswer answer = ask("POST", "/scanners/rig/calibrations");
    ASSERT_EQ(answer.status, 202) << answer.body;
    const json job = end_of("/jobs/" + json::parse(answer.body)["job"].get<std::string>());
    ASSERT_EQ(job["state"], "done") << job;
  }
  std::string begin_scan(int steps = kSteps) {
    const HttpAnswer answer = ask(
        "POST", "/scans",
        {{"scanner", "rig"}, {"steps", steps}, {"publish", true}, {"metadata", {{"title", "t"}}}});
    EXPECT_EQ(answer.status, 202) << answer.body;
    return "/scans/" + json::parse(answer.body)["id"].get<std::string>();
  }
  // Waits until a job or a scan has ended, and returns it.
  json end_of(const std::string& target) {
    json now;
    wait_until([&] {
      now = get(target);
      const std::string state = now["state"];
      return state == "done" || state == "failed" || state == "cancelled";
    });
    return now;
  }
  std::string exported(const json& scan) {
    return ask("GET", "/models/" + scan["model"].get<std::string>() + "/export.ply").body;
  }

  // Asks the rig itself for its state, which may differ from the state that the daemon assumes.
  RigLook look() const {
    const json config = json::parse(text(path("rig.json")));
    return look_at_rig(config["rig"]["socket"].get<std::string>());
  }

  const std::vector<std::string> options_;
  TemporaryFolder folder_;
  std::string token_;
  ProgramResult result_;
  std::thread rig_;
};

TEST_F(DaemonAtRig, ItCalibratesScansAndPublishesAndThePointsGrow) {
  const json scanner = get("/scanners/rig");
  EXPECT_EQ(scanner["state"], "idle") << scanner;
  EXPECT_EQ(scanner["calibration"], nullptr);
  calibrate();
  EXPECT_EQ(get("/scanners/rig")["calibration"], 1);
  const std::string scan = begin_scan();
  wait_until([&] { return get(scan)["step"] >= 4; });
  const std::size_t early = ask("GET", scan + "/points").body.size();
  EXPECT_GT(early, 0u);
  EXPECT_FALSE(get(scan + "/profile").empty());
  const json done = end_of(scan);
  ASSERT_EQ(done["state"], "done") << done;
  EXPECT_EQ(done["calibration"], 1);
  EXPECT_GT(ask("GET", scan + "/points").body.size(), early);
  EXPECT_EQ(get("/models/" + done["model"].get<std::string>())["title"], "t");
}

TEST_F(DaemonAtRig, KilledInTheMiddleItGoesOnAndTheMeshIsTheSame) {
  calibrate();
  const json calm = end_of(begin_scan());
  ASSERT_EQ(calm["state"], "done") << calm;
  const std::string scan = begin_scan();
  wait_until([&] { return get(scan)["step"] >= kSteps / 3; });
  kill_daemon();
  const json resumed = end_of(scan);
  ASSERT_EQ(resumed["state"], "done") << resumed;
  EXPECT_TRUE(exported(resumed) == exported(calm));
}

TEST_F(DaemonAtRig, StoppedInTheMiddleItGoesOnAtTheNextStart) {
  calibrate();
  const std::string scan = begin_scan();
  wait_until([&] { return get(scan)["step"] >= kSteps / 3; });
  const std::string before = text(path("pid"));
  signal_daemon(SIGTERM);
  wait_until([&] { return text(path("pid")) != before; });
  wait_for_port();
  EXPECT_GE(get(scan)["step"], kSteps / 3);
  EXPECT_EQ(end_of(scan)["state"], "done");
}

TEST_F(DaemonAtRig, TheWalkthroughInTheReadmeEndsWithAPublicModel) {
  const std::string script = VITRINE_SOURCE_DIR "/deploy/examples/scan.sh";
  const std::string shown = text(script).substr(text(script).find("ask() {"));
  EXPECT_NE(text(VITRINE_SOURCE_DIR "/acquisition/README.md").find("```\n" + shown + "```\n"),
            std::string::npos);
  const ProgramResult walked =
      run_program({"env", fmt::format("URL=http://127.0.0.1:{}", std::stoi(text(path("port")))),
                   "T=" + token_, "SCANNER=rig", script});
  ASSERT_EQ(walked.exit_code, 0) << walked.errors << walked.output;
  const json models = get("/models")["models"];  // published models only
  ASSERT_EQ(models.size(), 1u) << walked.output;
  EXPECT_EQ(models[0]["title"], "Bust");
}

// A rig whose table takes one second for each of the eight steps of a revolution.
class DaemonAtSlowRig : public DaemonAtRig {
 protected:
  static constexpr int kFewSteps = 8;
  static constexpr double kOneStep = 360.0 / kFewSteps;  // angle of a step, in degrees

  DaemonAtSlowRig() : DaemonAtRig({"--degrees-per-second", fmt::format("{}", kOneStep)}) {}

  void wait_until_it_turns() const {
    const double before = look().degrees;
    wait_until([&] { return look().degrees != before; });
  }
  bool is_off() const {
    const RigLook now = look();
    return !now.laser && !now.motor;
  }
};

TEST_F(DaemonAtSlowRig, AnEmergencyStopWhileTheTableTurnsSwitchesLaserAndMotorOff) {
  calibrate();
  const std::string scan = begin_scan(kFewSteps);
  wait_until([&] { return get(scan)["step"] >= 1; });
  wait_until_it_turns();
  EXPECT_TRUE(look().motor);
  EXPECT_EQ(ask("POST", "/scanners/rig/stop").status, 200);
  wait_until([&] { return is_off(); });
  const double halted_at = look().degrees;
  EXPECT_GT(std::abs(std::remainder(halted_at, kOneStep)), 0.1) << "it turned on";
  wait_until([&] { return get(scan)["state"] == "paused"; });
  EXPECT_TRUE(is_off());
  EXPECT_EQ(look().degrees, halted_at);

  EXPECT_EQ(ask("POST", scan + "/resume").status, 202);
  EXPECT_EQ(end_of(scan)["state"], "done");
}

}  // namespace
}  // namespace vitrine::test
