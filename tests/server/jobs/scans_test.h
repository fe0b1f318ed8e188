// SPDX-License-Identifier: Apache-2.0
// A fixture for scans: a service on a data folder, with a simulated scanner.
#pragma once

#include <gtest/gtest.h>

#include <thread>

#include "server/jobs/scan_service.h"
#include "server/store/installation.h"
#include "support/fake_backend.h"
#include "support/temporary_folder.h"

namespace vitrine::server {

class ScansTest : public testing::Test {
 protected:
  ScansTest() { start(); }

  // Starts a new service on the same folder, as a restarted daemon does.
  void start(std::chrono::milliseconds idle_timeout = std::chrono::hours(1)) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world_));
    service_ =
        std::make_unique<ScanService>(ScanServiceOptions{.store = *installation_.store,
                                                         .catalogue = *catalogue_,
                                                         .jobs = *installation_.jobs,
                                                         .events = events_,
                                                         .data = folder_.path(),
                                                         .program = VITRINE_BIN_DIR "/vitrined",
                                                         .idle_timeout = idle_timeout,
                                                         .quota = quota_.get(),
                                                         .when_added = when_added_,
                                                         .now = [this] { return now_.load(); }},
                                      std::move(backends));
    ASSERT_TRUE(service_->start());
  }
  void settle() {
    service_->jobs().executor(world_.name).run([] {});
  }
  // Begins a scan and stops the daemon after seven steps are measured.
  ScanStarted begin_and_stop() {
    test::HeldAtStep held(world_, 7);
    const auto started = begin(order_);
    held.await();
    std::thread stopper([this] { service_->stop(); });
    while (service_->scan(order_, {}).error().message.find("stopping") == std::string::npos)
      std::this_thread::yield();
    held.open();
    stopper.join();
    EXPECT_EQ(world_.steps, 7);
    return started;
  }
  ScanInfo info(const ScanId& id) { return **service_->find(id); }
  ScanStarted begin(const ScanOrder& order) {
    const auto started = service_->scan(order, std::nullopt);
    EXPECT_TRUE(started) << started.error().message;
    return *started;
  }
  // Moves the clock forward by the longest time that a laser may stay on.
  void let_the_laser_end() { now_ = now_.load() + kLongestLit; }
  ScannerStation& station() { return *service_->scanner(world_.name); }

  const ScanOrder order_{
      .scanner = "rig", .request = {.steps = 12}, .metadata = {.title = "A ring"}};
  std::atomic<ScannerStation::Clock::time_point> now_{ScannerStation::Clock::now()};
  test::FakeScanner world_;
  test::TemporaryFolder folder_;
  Installation installation_ = open_installation({.folder = folder_.path()}).value();
  const Log events_ = Log::open("").value();
  Catalogue* catalogue_ = installation_.catalogue.get();  // the catalogue that the service uses
  std::function<void(const ModelId&)> when_added_;
  const Uploads uploads_{folder_.path() / "uploads", {}};
  std::unique_ptr<Quota> quota_;
  std::unique_ptr<ScanService> service_;
};

}  // namespace vitrine::server
