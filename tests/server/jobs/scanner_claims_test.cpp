// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/scanner_claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "server/jobs/fenced_devices.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

class Claimants : public testing::Test {
 protected:
  std::unique_ptr<ScannerClaims> daemon(const std::string& name, std::chrono::milliseconds lease,
                                        const std::string& address = "") {
    return std::make_unique<ScannerClaims>(*catalogue_, Log::open("").value(), Lease{name, lease},
                                           address);
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<JobCatalogue> catalogue_ =
      open_sqlite_jobs(folder_.path() / "catalogue.sqlite").value();
};

TEST_F(Claimants, OneOfTwoDaemonsConfiguredForAScannerCommandsIt) {
  const auto first = daemon("first", 1h, "http://a:1"), second = daemon("second", 1h, "http://b:2");
  first->start({"left"});
  second->start({"left"});
  EXPECT_TRUE(first->check("left"));
  const auto refused = second->check("left");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_THAT(refused.error().message, HasSubstr("another daemon drives scanner left"));
  EXPECT_TRUE(first->has_jobs_of("left"));
  EXPECT_FALSE(second->has_jobs_of("left"));
  EXPECT_EQ(first->address_of("left"), std::nullopt);
  EXPECT_EQ(second->address_of("left"), "http://a:1");
  EXPECT_THAT(second->others(), ElementsAre(Pair("http://a:1", ElementsAre("left"))));
}

TEST_F(Claimants, ADaemonSuspendedBeyondItsLeaseCommandsNothingAndLearnsTheNewDriver) {
  const auto first = daemon("first", 1h), second = daemon("second", 1h);
  first->start({"left"});
  second->start({"left"});
  ASSERT_TRUE(catalogue_->drop_scanners("first"));  // as if the first daemon's lease had expired
  second->beat();
  EXPECT_TRUE(second->check("left"));
  first->beat();
  EXPECT_FALSE(first->check("left"));
  EXPECT_FALSE(first->has_jobs_of("left"));
}

TEST_F(Claimants, NoDaemonWaitsForAnExpiredLease) {
  const auto first = daemon("first", 1h, "http://a:1"), second = daemon("second", 1h);
  first->start({"left"});
  second->beat();
  EXPECT_EQ(second->address_of("left"), "http://a:1");
  ASSERT_TRUE(catalogue_->drop_scanners("first"));  // as if the first daemon's lease had expired
  second->beat();
  EXPECT_EQ(second->address_of("left"), "");
  EXPECT_TRUE(second->others().empty());
  EXPECT_FALSE(second->has_jobs_of("left")) << "it may come back";
}

TEST_F(Claimants, ALeaseThatCouldNotBeRenewedDoesNotCountAsExpired) {
  const auto first = daemon("first", 1h), second = daemon("second", 1h),
             third = daemon("third", 1h);
  for (const auto* const one : {&first, &second, &third})
    (*one)->start({"left"});
  const auto database = sqlite::open_database(folder_.path() / "catalogue.sqlite").value();
  database->lease()->run("ALTER TABLE scanner RENAME TO away");
  second->beat();
  database->lease()->run("ALTER TABLE away RENAME TO scanner");
  ASSERT_TRUE(catalogue_->drop_scanners("first"));  // as if the first daemon's lease had expired
  second->beat();
  EXPECT_FALSE(second->check("left"));
  // The third daemon has just started and has not seen the failure of the catalogue. It therefore
  // acquires the scanner at once.
  third->beat();
  EXPECT_TRUE(third->check("left"));
}

TEST_F(Claimants, AnExpiredLeaseIsKnownWithoutTheCatalogue) {
  const auto daemon_ = daemon("first", 0ms);
  daemon_->start({"left"});
  const auto refused = daemon_->check("left");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("scanner left is paused"));
  EXPECT_TRUE(daemon_->has_jobs_of("left")) << "nobody else has taken it";
}

TEST_F(Claimants, AnyDaemonReportsAScannerThatWasNeverDriven) {
  const auto first = daemon("first", 1h), second = daemon("second", 1h);
  first->start({"left"});
  second->start({});
  EXPECT_TRUE(second->has_jobs_of("nowhere"));
  EXPECT_FALSE(second->has_jobs_of("left"));
}

class CountingBoard final : public acquisition::Board {
 public:
  explicit CountingBoard(int& commands) : commands_(commands) {}
  const acquisition::BoardIdentity& identity() const override { return identity_; }
  Expected<std::optional<double>> position() override {
    ++commands_;
    return 0.0;
  }
  Expected<void> set_position(double) override { return count(); }
  Expected<void> turn_to(double) override { return count(); }
  Expected<void> laser(bool) override { return count(); }
  Expected<void> rest() override { return count(); }
  void emergency_stop() noexcept override { ++commands_; }

 private:
  Expected<void> count() {
    ++commands_;
    return {};
  }
  int& commands_;
  const acquisition::BoardIdentity identity_;
};

TEST(FencedDevices, ADaemonThatMayNotCommandCanOnlyStopTheBoard) {
  int commands = 0;
  bool may = true;
  const acquisition::ScannerDevices devices =
      fenced({.open_camera = [] { return fail(ErrorCode::kIo, "there is none"); },
              .open_board = [&]() -> Expected<std::unique_ptr<acquisition::Board>> {
                return std::make_unique<CountingBoard>(commands);
              }},
             [&]() -> Expected<void> {
               return may ? Expected<void>() : fail(ErrorCode::kIo, "another daemon drives it");
             });
  const auto board = devices.open_board().value();
  EXPECT_TRUE(board->turn_to(10));
  EXPECT_TRUE(board->laser(true));
  EXPECT_EQ(commands, 2);
  may = false;
  EXPECT_FALSE(board->turn_to(20));
  EXPECT_FALSE(board->laser(true));
  EXPECT_FALSE(board->position());
  EXPECT_FALSE(board->set_position(0));
  EXPECT_FALSE(board->rest());
  EXPECT_FALSE(devices.open_board());
  EXPECT_EQ(devices.open_camera().error().message, "another daemon drives it");
  EXPECT_EQ(commands, 2);
  board->emergency_stop();
  EXPECT_EQ(commands, 3);
}

}  // namespace
}  // namespace vitrine::server
