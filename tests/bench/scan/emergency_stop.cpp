// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "rig_run.h"
#include "sections.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/rig_operator.h"

namespace vitrine::bench {
namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

constexpr int kStops = 10;
constexpr double kMostMs = 100;  // limit in milliseconds for the slowest stop

void wait_until(const std::function<bool()>& condition) {
  const auto end = Clock::now() + std::chrono::minutes(1);
  while (!condition()) {
    if (Clock::now() > end) throw std::runtime_error("the daemon or its scanner does not answer");
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

// Sends an operator's requests to the daemon whose data folder is given.
class Operator {
 public:
  explicit Operator(const std::filesystem::path& folder)
      : token_(json::parse(std::ifstream(folder / "token.json")).at("token")) {
    wait_until([&] { return static_cast<bool>(std::ifstream(folder / "port") >> port_); });
  }

  int post(const std::string& command, const std::string& body) const {
    test::HttpClient client(port_);
    client.send("POST /api/v1/scanners/rig/" + command + " HTTP/1.1\r\nHost: a\r\n" +
                "Authorization: Bearer " + token_ + "\r\nContent-Type: application/json\r\n" +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive().status;
  }

 private:
  std::string token_;
  std::uint16_t port_ = 0;
};

// Switches the laser on, turns the table and sends an emergency stop. Returns the milliseconds
// until laser and motor are off.
double stop_once(const Operator& caller, const std::filesystem::path& door) {
  if (caller.post("laser", R"({"on": true})") != 200)
    throw std::runtime_error("the laser does not light");
  const double before = test::look_at_rig(door).degrees;
  const std::jthread turning([&] { caller.post("jog", R"({"degrees": 360})"); });
  wait_until([&] {
    const test::RigLook now = test::look_at_rig(door);
    return now.laser && now.motor && now.degrees != before;
  });
  const auto begun = Clock::now();
  const std::jthread stopping([&] { caller.post("stop", "{}"); });
  wait_until([&] {
    const test::RigLook now = test::look_at_rig(door);
    return !now.laser && !now.motor;
  });
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

}  // namespace

int run_emergency_stops(const std::filesystem::path& folder) {
  const Operator caller(folder);
  const json config = json::parse(std::ifstream(folder / "rig.json"));
  const std::filesystem::path door = config.at("rig").at("socket").get<std::string>();
  for (int i = 0; i < kStops; ++i)
    std::printf("%.3f\n", stop_once(caller, door));
  return 0;
}

void emergency_stop(Report& report, const Object& object) {
  constexpr int kSteps = 720;
  const RigFolder folder;
  at_rig(
      folder, object, kSteps,
      "mkdir data\n" + program("vitrine") +
          " token create --role operator --data data --json > token.json\n" + program("vitrined") +
          " --listen 127.0.0.1:0 --port-file port --data data --scanners rig.json > log 2>&1 &\n" +
          program("bench-scan") + " --emergency-stops . > stops\nkill $!\nwait $!\n",
      "--degrees-per-second 100");
  double slowest = 0;
  std::ifstream stops(folder / "stops");
  for (double ms = 0; stops >> ms;)
    slowest = std::max(slowest, ms);
  judge(report, "speed.emergency_stop", "ms_until_off", slowest, kMostMs);
}

}  // namespace vitrine::bench
