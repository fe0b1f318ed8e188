// SPDX-License-Identifier: Apache-2.0
// Tests of what a daemon makes of its scans: a service over a folder, with a scanner that obeys.
#pragma once

#include <gtest/gtest.h>

#include <thread>

#include "server/jobs/scan_service.h"
#include "server/store/installation.h"
#include "support/fake_backend.h"
#include "support/temporary_folder.h"

namespace vitrine {

class ScansTest : public testing::Test {
 protected:
  ScansTest() { start(); }

  // A daemon's life: a new service over the same folder.
  void start(std::chrono::milliseconds patience = std::chrono::hours(1)) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(world_));
    service_ = std::make_unique<ScanService>(ScanMeans{*installation_.store,
                                                       *installation_.catalogue,
                                                       *installation_.jobs,
                                                       events_,
                                                       folder_.path(),
                                                       VITRINE_BIN_DIR "/vitrined",
                                                       patience,
                                                       {},
                                                       quota_.get()},
                                             std::move(backends));
    ASSERT_TRUE(service_->start());
  }
  void settle() {
    service_->jobs().lane(world_.name).run([] {});
  }
  // A scan of which seven steps are measured when the daemon stops.
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
  ScannerStation& station() { return *service_->scanner(world_.name); }

  const ScanOrder order_{
      .scanner = "rig", .request = {.steps = 12}, .metadata = {.title = "A ring"}};
  test::FakeScanner world_;
  test::TemporaryFolder folder_;
  Installation installation_ = open_installation({.folder = folder_.path()}).value();
  const Log events_ = Log::open("").value();
  const Uploads uploads_{folder_.path() / "uploads", {}};
  std::unique_ptr<Quota> quota_;
  std::unique_ptr<ScanService> service_;
};

}  // namespace vitrine
