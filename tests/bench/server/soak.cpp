// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <csignal>
#include <future>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "scans.h"
#include "sections.h"
#include "side_view.h"
#include "stream_peer.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/resident_memory.h"
#include "support/served_folder.h"
#include "support/wavy_sheet.h"

namespace vitrine::bench {
namespace {

using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Puts a museum's load of a whole day on a daemon within ten minutes. Visitors of each kind
// repeatedly come, send their requests and leave.
class Soak {
 public:
  Soak()
      : scan_(scan("demosthenes")),
        id_(folder_.publish("a scan", scan_.pmesh)),
        bearer_("Authorization: Bearer " + folder_.token(Role::kOperator) + "\r\n"),
        // These settings ensure that the caches are full before the second half of the run begins.
        daemon_(folder_.path(), {"--export-cache", "8000000", "--collect-after", "10"}) {}

  struct Sample {
    double minutes, kilobytes;
  };

  std::vector<Sample> run(std::chrono::seconds time, milliseconds between) {
    const auto start = Clock::now();
    end_ = start + time;
    std::vector<std::future<void>> busy;
    for (unsigned i = 0; i < 3; ++i)
      busy.push_back(std::async(std::launch::async, [this, i] { look(i); }));
    busy.push_back(std::async(std::launch::async, [this] { download(); }));
    busy.push_back(std::async(std::launch::async, [this] { publish(); }));
    busy.push_back(std::async(std::launch::async, [this] { misbehave(); }));
    std::vector<Sample> samples;
    while (is_on(between)) {
      const std::chrono::duration<double, std::ratio<60>> since = Clock::now() - start;
      samples.push_back(
          {since.count(), static_cast<double>(test::resident_bytes(daemon_.pid())) / 1000});
    }
    for (auto& one : busy)
      one.get();
    return samples;
  }

  std::size_t visits() const { return visits_; }

  // Stops the daemon. Throws unless its exit code is 0 and its log has no error.
  void stop() {
    daemon_.signal(SIGTERM);
    const test::ProgramResult end = daemon_.wait();
    if (end.exit_code != 0 || end.output.find("event=error") != std::string::npos)
      throw std::runtime_error("the daemon has faults to tell: " + end.output);
  }

 private:
  // Pauses for the duration `breath`. Returns whether there is time left for another visit.
  bool is_on(milliseconds breath) {
    std::this_thread::sleep_for(breath);
    return Clock::now() < end_;
  }

  // Repeatedly connects, refines, turns the model and disconnects without a close frame.
  void look(unsigned seed) {
    std::mt19937 random(seed);
    for (; is_on(milliseconds(20)); ++visits_) {
      StreamPeer peer(daemon_.port(), id_, test::kLoopback, "?head=true");
      peer.say(WantMessage{.turn = 1, .target = Want(WantTriangles{1'000 + random() % 20'000})});
      follow(peer, random() % 20);
      peer.say(WantMessage{
          .turn = 2, .target = Want(side_view(scan_.pmesh.manifest, random() % 2 == 0 ? 1 : -1))});
      follow(peer, random() % 20);
      peer.say(WantMessage{.turn = 3, .target = WantSeconds{0.2}});
      follow(peer, 20);
    }
  }
  static void follow(StreamPeer& peer, std::size_t events) {
    for (bool done = false; events > 0 && !done; --events) {
      const auto event = peer.next();
      done = event.message && std::holds_alternative<DoneMessage>(*event.message);
    }
  }

  void download() {
    std::mt19937 random(7);
    const std::string model = "/api/v1/models/" + id_;
    const auto& chunks = scan_.pmesh.manifest.chunks;
    for (; is_on(milliseconds(20)); ++visits_) {
      test::HttpClient client(daemon_.port());
      expect(client.get(model + "/head"), 200);
      const test::HttpAnswer manifest = client.get(model + "/manifest");
      expect(manifest, 200);
      expect(client.get(model + "/manifest", "If-None-Match: " + manifest.field("etag") + "\r\n"),
             304);
      expect(client.get("/api/v1/chunks/" + to_hex(chunks[random() % chunks.size()].sha256)), 200);
      expect(
          client.get(model + "/export.glb?triangles=" + std::to_string(1'000 * (1 + random() % 9))),
          200);
    }
  }

  // Repeatedly uploads a mesh, publishes it, exports it and deletes it.
  void publish() {
    const std::string mesh = test::wavy_sheet(30);
    for (int i = 0; is_on(milliseconds(200)); ++visits_, ++i) {
      const test::HttpAnswer upload =
          send("POST", "/api/v1/uploads",
               "Tus-Resumable: 1.0.0\r\nContent-Type: application/offset+octet-stream\r\n"
               "Upload-Length: " +
                   std::to_string(mesh.size()) + "\r\n",
               mesh);
      expect(upload, 201);
      const std::string path = upload.field("location");
      const test::HttpAnswer accepted =
          send("POST", "/api/v1/models", "Content-Type: application/json\r\n",
               Json{{"upload", path.substr(path.rfind('/') + 1)},
                    {"publish", true},
                    {"metadata", {{"title", std::to_string(i)}}}}
                   .dump());
      expect(accepted, 202);
      const std::string model = "/api/v1/models/" + model_of(accepted.field("location"));
      expect(send("GET", model + "/export.ply"), 200);
      expect(send("DELETE", model), 204);
      daemon_.wait_for_line("method=DELETE");  // reads the log, so that the pipe does not fill
    }
  }
  std::string model_of(const std::string& job) {
    for (;;) {
      const Json now = Json::parse(send("GET", job).body);
      if (now.value("state", "") == "done") return now.value("model", "");
      if (now.value("state", "") == "failed") throw std::runtime_error(now.dump());
      std::this_thread::sleep_for(milliseconds(50));
    }
  }

  void misbehave() {
    const std::string good = "GET / HTTP/1.1\r\nHost: a\r\n";
    const std::pair<std::string, int> wrong[] = {
        {"GET / HTTP/1.1\r\n\r\n", 400},
        {"nonsense\r\n\r\n", 400},
        {good + "Transfer-Encoding: chunked\r\nContent-Length: 1\r\n\r\n", 400},
        {"GET /api/v1/models/none HTTP/1.1\r\nHost: a\r\n\r\n", 404},
        {"POST /api/v1/models HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n", 401},
        {"GET /api/v1/models/" + id_ + "/export.ply?triangles=x HTTP/1.1\r\nHost: a\r\n\r\n", 400},
        {good.substr(0, 9), 0},  // an incomplete request, which gets no response
    };
    for (std::size_t i = 0; is_on(milliseconds(20)); ++visits_, ++i) {
      const auto& [request, status] = wrong[i % std::size(wrong)];
      test::HttpClient client(daemon_.port());
      client.send(request);
      if (status != 0) expect(client.receive(), status);
      if (i % 10 == 0) guess_a_token();
    }
  }

  // The server answers ten requests with wrong tokens per minute and throttles further ones.
  void guess_a_token() {
    test::HttpClient client(daemon_.port());
    client.send("GET /api/v1/jobs HTTP/1.1\r\nHost: a\r\nAuthorization: Bearer vtr_guess\r\n\r\n");
    const test::HttpAnswer answer = client.receive();
    if (answer.status != 429) expect(answer, 401);
  }

  test::HttpAnswer send(const std::string& method, const std::string& target,
                        const std::string& fields = "", const std::string& body = "") {
    test::HttpClient client(daemon_.port());
    client.send(method + " " + target + " HTTP/1.1\r\nHost: a\r\n" + bearer_ + fields +
                "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
    return client.receive();
  }
  static void expect(const test::HttpAnswer& answer, int status) {
    if (answer.status == status) return;
    throw std::runtime_error("an answer is " + std::to_string(answer.status) + " and not " +
                             std::to_string(status) + ": " + answer.body.substr(0, 500));
  }

  test::ServedFolder folder_;
  const Scan& scan_;
  const std::string id_, bearer_;
  test::Daemon daemon_;
  Clock::time_point end_;
  std::atomic<std::size_t> visits_ = 0;
};

// Fits a line to the samples from `first` on. Returns its slope: the growth of memory in kilobytes
// per minute.
double slope(const std::vector<Soak::Sample>& samples, std::size_t first) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t i = first; i < samples.size(); ++i) {
    const auto& [minutes, kilobytes] = samples[i];
    n += 1, x += minutes, y += kilobytes;
    xx += minutes * minutes, xy += minutes * kilobytes;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

void soak(Report& report, const Effort& effort) {
  // Limit of the growth, in kilobytes per minute. At a few thousand visits per minute, it allows
  // less than 100 bytes per visit. A leaked session, the smallest object that a visit could leave
  // behind, has thousands of bytes.
  constexpr double kFlat = 256;
  const std::chrono::seconds time(effort.is_quick ? 60 : 600);
  Soak soak;
  const auto samples = soak.run(time, milliseconds(200));
  soak.stop();
  const double visits =
      static_cast<double>(soak.visits()) / (static_cast<double>(time.count()) / 60);
  const std::size_t half = samples.size() / 2;
  const double last = samples.back().kilobytes, grown = slope(samples, half);
  report.add({"soak", "visits_a_minute", visits, 0, visits, kNoThreshold});
  report.add({"soak", "kilobytes_a_minute", last, samples[half].kilobytes, grown, kFlat});
}

}  // namespace vitrine::bench
