// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <stdexcept>
#include <vector>

#include "codec/base/base_decoder.h"
#include "medians.h"
#include "scans.h"
#include "sections.h"
#include "shaped_link.h"
#include "stream_peer.h"
#include "support/process/daemon.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::bench {
namespace {

constexpr double kRate = 200'000;  // bytes per second: 1.6 Mbit/s
constexpr double kRoundTrip = std::chrono::duration<double>(kLongWay).count();

struct Shown {
  const Scan& scan;
  std::string id;
};

// A visitor whose viewer has an empty cache and no open connection.
class ColdVisitor {
 public:
  ColdVisitor(Medians& figures, const std::vector<const Scan*>& scans)
      : figures_(figures), link_(kLongWay) {
    for (const Scan* scan : scans)
      shown_.push_back({*scan, folder_.publish(scan->name, scan->pmesh)});
    daemon_.emplace(folder_.path(), std::vector<std::string>{"--listen", "0.0.0.0:0"});
    link_.shape(kRate);
  }

  void look_at_all() {
    for (const Shown& shown : shown_) {
      over_http(shown);
      over_websocket(shown);
    }
  }

 private:
  struct Times {
    double start, first, end;  // in seconds; `first` is the arrival of the response's first byte
  };

  void over_http(const Shown& shown) {
    Times times{.start = StreamPeer::now()};
    test::HttpClient client(daemon_->port(), ShapedLink::kServer);
    client.send("GET /api/v1/models/" + shown.id + "/head HTTP/1.1\r\nHost: localhost\r\n\r\n");
    if (client.is_closed())
      throw std::runtime_error("no answer");  // is_closed() waits for the response
    times.first = StreamPeer::now();
    const std::string head = client.receive().body;
    times.end = StreamPeer::now();
    report("first_triangle_http", shown.scan, times, {head.begin(), head.end()});
  }

  void over_websocket(const Shown& shown) {
    Times times{.start = StreamPeer::now()};
    StreamPeer peer(daemon_->port(), shown.id, ShapedLink::kServer, "?head=true");
    while (peer.head.size() < shown.scan.pmesh.manifest.head_bytes()) {
      const auto event = peer.next();
      times.end = event.at;
      if (event.slice && times.first == 0) times.first = event.at;
    }
    report("first_triangle_websocket", shown.scan, times, peer.head);
  }

  // The connection and the request take two round trips. A second request would take a third round
  // trip.
  void report(const char* way, const Scan& scan, const Times& times,
              const std::vector<std::uint8_t>& head) {
    check(head);
    const std::string what = scan.name + "." + way;
    const double trips = (times.first - times.start) / kRoundTrip;
    figures_.add({what, "round_trips", trips, 2, trips, 2.5});
    const double took = times.end - times.start;
    const double least = 2 * kRoundTrip + static_cast<double>(head.size()) / kRate;
    figures_.add({what, "seconds", took, least, took / least, 1.5});
  }

  // Throws unless the received bytes are exactly the head (header and base mesh), which is all that
  // the first picture needs.
  static void check(const std::vector<std::uint8_t>& head) {
    const auto manifest = parse_header(head);
    const bool is_whole = manifest && manifest->head_bytes() == head.size();
    if (is_whole && decode_base(std::span(head).subspan(manifest->base_offset), *manifest)) return;
    throw std::runtime_error("the first answer is no head");
  }

  Medians& figures_;
  test::ServedFolder folder_;
  ShapedLink link_;
  std::vector<Shown> shown_;
  std::optional<test::Daemon> daemon_;
};

}  // namespace

void first_triangle(Report& report, const Effort& effort) {
  std::vector<const Scan*> scans = {&scan("demosthenes"), &scan("skull")};
  if (!effort.is_quick) scans.push_back(&scan(kLargeScan));
  Medians figures;
  ColdVisitor visitor(figures, scans);
  for (int run = 0; run < (effort.is_quick ? 1 : 5); ++run)
    visitor.look_at_all();
  figures.report(report);
}

}  // namespace vitrine::bench
