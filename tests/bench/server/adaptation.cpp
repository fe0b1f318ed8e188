// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>

#include "../../server/app/served_folder.h"
#include "sections.h"
#include "server/jobs/build_model.h"
#include "shaped_link.h"
#include "stream_peer.h"
#include "support/daemon.h"

namespace vitrine::bench {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The largest scan that is there: a .pmesh as it is, a mesh built.
test::TinyPmesh largest_scan() {
  const char* const set = std::getenv("VITRINE_MODELS");
  const fs::path folder = set != nullptr ? set : VITRINE_SOURCE_DIR "/tests/models";
  for (const char* const name :
       {"ct-skull-2753k.pmesh", "ct-skull-2753k.ply", "ct-skull-529k.ply", "skull.obj"}) {
    if (!fs::exists(folder / name)) continue;
    test::TinyPmesh scan{.bytes = read(folder / name)};
    if (fs::path(name).extension() != ".pmesh")
      scan.bytes = build_model(scan.bytes, {}, [](std::string_view, double) {}).value().file;
    scan.manifest = parse_header(scan.bytes).value();
    return scan;
  }
  throw std::runtime_error(folder.string() + " holds no scan; set VITRINE_MODELS");
}

class Adaptation {
 public:
  explicit Adaptation(Report& report) : report_(report) {
    const test::TinyPmesh scan = largest_scan();
    manifest_ = scan.manifest;
    id_ = folder_.publish("a scan", scan);
    daemon_.emplace(folder_.path(), std::vector<std::string>{"--listen", "0.0.0.0:0"});
    link_.at_client();
  }

  void seconds(double rate) {
    link_.shape(rate);
    const auto peer = connect();
    const double start = StreamPeer::now();
    peer->say(WantMessage{.wish = WantSeconds{kSeconds}});
    std::size_t bytes = 0;
    double end = 0;
    while (end == 0) {
      const auto event = peer->next();
      bytes += event.bytes;
      if (event.message && std::holds_alternative<DoneMessage>(*event.message)) end = event.at;
    }
    const double took = end - start;
    const bool is_whole = bytes + 1 > manifest_.file_bytes - manifest_.head_bytes();
    const double off = is_whole && took < kSeconds ? 0 : std::abs(took / kSeconds - 1);
    const double used = static_cast<double>(bytes) / (rate * (is_whole ? took : kSeconds));
    report_.add({name("seconds", rate), "off_target", took, kSeconds, off, 0.15});
    report_.add({name("seconds", rate), "link_used", static_cast<double>(bytes), rate * kSeconds,
                 used, 0.85, true});
  }

  // How late promises after the drop come, and how they are kept.
  void drop(double from, double to) {
    link_.shape(from);
    const auto peer = connect();
    const double start = StreamPeer::now();
    double dropped = 0, noticed = 0, end = 0;
    std::vector<std::pair<double, double>> promises;  // made at, for
    peer->say(WantMessage{.wish = WantSeconds{4}});
    while (end == 0) {
      const auto event = peer->next();
      if (dropped == 0 && event.at - start > 1) {
        link_.shape(to);
        dropped = StreamPeer::now();
      }
      if (!event.message) continue;
      if (std::holds_alternative<DoneMessage>(*event.message)) end = event.at;
      const auto* promise = std::get_if<PromiseMessage>(&*event.message);
      if (promise == nullptr || dropped == 0) continue;
      const bool knows = promise->bytes_per_second < 2 * to;
      if (noticed == 0 && knows) noticed = event.at;
      if (noticed > 0 && promise->seconds > kShortest)
        promises.emplace_back(event.at, promise->seconds);
    }
    double worst = 0;
    for (const auto& [at, seconds] : promises)
      worst = std::max(worst, (end - at) / seconds);
    const double late = noticed > 0 ? noticed - dropped : end - dropped;
    report_.add({"drop_800_to_100", "seconds_to_notice", late, 0, late, 1});
    report_.add({"drop_800_to_100", "promise_kept", 0, 0, worst, 1.5});
  }

  // From a new view to its first slice. The answer to a model that is not there
  // marks where it begins: what follows was chosen after it.
  void view_change(double rate) {
    link_.shape(rate);
    const auto peer = connect();
    const double trip = round_trip(*peer);
    peer->say(WantMessage{.turn = 1, .wish = Want(view_from(1))});
    const double start = StreamPeer::now();
    while (StreamPeer::now() - start < 1.2) {
      const auto event = peer->next();
      if (event.message && std::holds_alternative<DoneMessage>(*event.message))
        return;  // too small
    }
    peer->say(WantMessage{.turn = 2, .wish = Want(view_from(-1))});
    peer->say(OpenMessage{.model = 1, .id = "none"});
    const double asked = StreamPeer::now();
    bool is_new = false;
    for (;;) {
      const auto event = peer->next();
      const auto* done = event.message ? std::get_if<DoneMessage>(&*event.message) : nullptr;
      is_new = is_new || (event.message && std::holds_alternative<ClosedMessage>(*event.message));
      if (!is_new || (!event.slice && (done == nullptr || done->turn != 2))) continue;
      const double waited = event.at - asked - trip;
      report_.add({name("view_change", rate), "seconds_queued", waited, 0, waited, 0.15});
      return;
    }
  }

 private:
  static constexpr double kSeconds = 2;
  static constexpr double kShortest = 0.1;  // promises for less than the tools take are not judged

  static std::string name(const char* what, double rate) {
    return std::string(what) + "_" + std::to_string(static_cast<int>(rate / 1000));
  }

  std::unique_ptr<StreamPeer> connect() {
    auto peer = std::make_unique<StreamPeer>(daemon_->port(), id_, ShapedLink::kServer);
    while (!peer->next().message) {
    }
    return peer;
  }

  static double round_trip(StreamPeer& peer) {
    const double asked = StreamPeer::now();
    peer.say(WantMessage{.wish = Want(WantBytes{0})});
    while (!peer.next().message) {
    }
    return StreamPeer::now() - asked;
  }

  // From beside the model, to the right (1) or left (-1), to a hundredth of a pixel.
  View view_from(double side) const {
    const double size = manifest_.lattice.step * std::exp2(manifest_.lattice.bits);
    const Vec3 box = to_vec3(manifest_.tree.nodes[0].box.low + manifest_.tree.nodes[0].box.high);
    const Vec3 centre = manifest_.lattice.origin + box * (manifest_.lattice.step / 2);
    return {.camera = {0, 0, -side, 0, 0, 1, 0, 0, side, 0, 0, 0, centre.x + side * size, centre.y,
                       centre.z, 1},
            .field_of_view = 60,
            .width = 1920,
            .height = 1080,
            .pixel_error = 0.01};
  }

  Report& report_;
  test::ServedFolder folder_;
  ShapedLink link_;
  Manifest manifest_;
  std::string id_;
  std::optional<test::Daemon> daemon_;
};

}  // namespace

void adaptation(Report& report, const Effort& effort) {
  Adaptation adaptation(report);
  for (const double rate : {100'000., 400'000., 800'000.}) {
    if (effort.quick && rate != 400'000.) continue;
    adaptation.seconds(rate);
    adaptation.view_change(rate);
  }
  adaptation.drop(800'000, 100'000);
}

}  // namespace vitrine::bench
