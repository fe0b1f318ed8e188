// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "detail_progress.h"
#include "medians.h"
#include "scans.h"
#include "sections.h"
#include "shaped_link.h"
#include "side_view.h"
#include "stream_peer.h"
#include "support/process/daemon.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::bench {
namespace {

class Adaptation {
 public:
  Adaptation(Medians& figures, const Scan& scan, std::chrono::milliseconds round_trip)
      : figures_(figures),
        scan_(scan.name),
        manifest_(scan.pmesh.manifest),
        link_(round_trip),
        id_(folder_.publish("a scan", scan.pmesh)),
        late_(round_trip.count() > 0) {
    daemon_.emplace(folder_.path(), std::vector<std::string>{"--listen", "0.0.0.0:0"});
    link_.at_client();
  }

  void seconds(double rate) {
    link_.shape(rate);
    const auto peer = connect();
    const double start = StreamPeer::now();
    peer->say(WantMessage{.target = WantSeconds{kSeconds}});
    DetailProgress course(manifest_);
    while (!course.is_done())
      course.take(peer->next());
    const double took = course.done() - start, bytes = static_cast<double>(course.received());
    const bool is_whole = course.level() + 1 == manifest_.levels.size();
    const double off = is_whole && took < kSeconds ? 0 : std::abs(took / kSeconds - 1);
    const double could = rate * (is_whole ? took : kSeconds);
    figures_.add({name("seconds", rate), "off_target", took, kSeconds, off, 0.15});
    figures_.add({name("seconds", rate), "link_used", bytes, could, bytes / could, 0.85,
                  /*is_minimum=*/true});
    const double promised =
        course.forecasts().empty() ? kNever : course.forecasts().back().promise.level;
    figures_.add({name("seconds", rate), "levels_short", static_cast<double>(course.level()),
                  promised, std::max(0.0, promised - course.level()), 0});
    first_guess(course, rate);
  }

  // Measures how soon the server's forecasts follow a drop of the link's rate, and whether the
  // forecasts come true.
  void drop(double from, double to) {
    link_.shape(from);
    const auto peer = connect();
    const double start = StreamPeer::now();
    double dropped = kNever;
    peer->say(WantMessage{.target = WantSeconds{4}});
    DetailProgress course(manifest_);
    while (!course.is_done()) {
      const auto event = peer->next();
      course.take(event);
      const bool is_amid = event.at > start + 1 || course.received() > manifest_.file_bytes / 3;
      if (dropped != kNever || !is_amid) continue;
      link_.shape(to);
      dropped = StreamPeer::now();
    }
    double noticed = kNever;
    // The default is a forecast that never came true. The measurement therefore fails if the server
    // sends no forecast.
    ReceivedForecast worst{.promise = {}, .at = 0};
    bool any = false;
    for (const ReceivedForecast& heard : course.forecasts()) {
      if (heard.at < dropped || heard.promise.bytes_per_second >= 2 * to) continue;
      noticed = std::min(noticed, heard.at);
      if (heard.promise.seconds < kShortest) continue;
      if (!any || heard.ratio() > worst.ratio()) worst = heard;
      any = true;
    }
    const std::string what = scan_ + ".drop_800_to_100";
    const double late = noticed == kNever ? kNever : noticed - dropped;
    figures_.add({what, "seconds_to_notice", late, 0, late, 1});
    figures_.add({what, "promise_kept", worst.kept - worst.at, worst.promise.seconds,
                  any ? worst.ratio() : kNever, 1.5});
  }

  // Measures the time from a request for a new view to the first slice for that view. Right after
  // the request, the client opens a model that does not exist. Slices that arrive after the error
  // response to this second request were chosen for the new view.
  void view_change(double rate) {
    link_.shape(rate);
    const auto peer = connect();
    const double trip = round_trip(*peer);
    const std::string what = name(late_ ? "view_change_late" : "view_change", rate);
    peer->say(WantMessage{.turn = 1, .target = Want(side_view(manifest_, 1))});
    const double start = StreamPeer::now(), enough = static_cast<double>(manifest_.file_bytes) / 4;
    for (double bytes = 0; StreamPeer::now() - start < 1.2 && bytes < enough;) {
      const auto event = peer->next();
      bytes += static_cast<double>(event.bytes);
      if (!event.message || !std::holds_alternative<DoneMessage>(*event.message)) continue;
      // The model arrived completely before the view changed, so it is too small for this
      // measurement.
      return figures_.add({what, "seconds_queued", 0, 0, kNever, 0.15});
    }
    peer->say(WantMessage{.turn = 2, .target = Want(side_view(manifest_, -1))});
    peer->say(OpenMessage{.model = 1, .id = "none"});
    const double asked = StreamPeer::now();
    bool is_new = false;
    for (;;) {
      const auto event = peer->next();
      const auto* done = event.message ? std::get_if<DoneMessage>(&*event.message) : nullptr;
      is_new = is_new || (event.message && std::holds_alternative<ClosedMessage>(*event.message));
      if (!is_new || (!event.slice && (done == nullptr || done->turn != 2))) continue;
      const double waited = event.at - asked - trip;
      return figures_.add({what, "seconds_queued", waited, trip, waited, 0.15});
    }
  }

 private:
  static constexpr double kSeconds = 2;
  static constexpr double kShortest = 0.1;  // in seconds; shorter forecasts are not judged

  std::string name(const char* what, double rate) const {
    return scan_ + "." + what + "_" + std::to_string(static_cast<int>(rate / 1000));
  }

  // Checks that the server marks its first forecast as not measured, and that this forecast is not
  // too optimistic.
  void first_guess(const DetailProgress& course, double rate) {
    ReceivedForecast first{.promise = {}, .at = 0};
    if (!course.forecasts().empty() && !course.forecasts()[0].promise.is_measured)
      first = course.forecasts()[0];
    figures_.add({name("seconds", rate), "first_guess_kept", first.kept - first.at,
                  first.promise.seconds, first.ratio(), 1});
  }

  std::unique_ptr<StreamPeer> connect() {
    auto peer = std::make_unique<StreamPeer>(daemon_->port(), id_, ShapedLink::kServer);
    while (!peer->next().message) {
    }
    return peer;
  }

  static double round_trip(StreamPeer& peer) {
    const double asked = StreamPeer::now();
    peer.say(WantMessage{.target = Want(WantBytes{0})});
    while (!peer.next().message) {
    }
    return StreamPeer::now() - asked;
  }

  Medians& figures_;
  const std::string scan_;
  const Manifest& manifest_;
  test::ServedFolder folder_;
  ShapedLink link_;
  const std::string id_;
  const bool late_;
  std::optional<test::Daemon> daemon_;
};

}  // namespace

void adaptation(Report& report, const Effort& effort) {
  const Scan& shown = scan(effort.is_quick ? "skull" : kLargeScan);
  const std::vector<double> rates =
      effort.is_quick ? std::vector{400'000.} : std::vector{100'000., 400'000., 800'000.};
  Medians figures;
  const int runs = effort.is_quick ? 1 : 5;
  {
    Adaptation near(figures, shown, {});
    for (int run = 0; run < runs; ++run) {
      for (const double rate : rates) {
        near.seconds(rate);
        near.view_change(rate);
      }
      near.drop(800'000, 100'000);
    }
  }
  Adaptation far(figures, shown, kLongWay);
  for (int run = 0; run < runs; ++run)
    far.view_change(400'000);
  figures.report(report);
}

}  // namespace vitrine::bench
