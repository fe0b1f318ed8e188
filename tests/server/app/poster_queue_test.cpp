// SPDX-License-Identifier: Apache-2.0
#include "server/app/poster_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <functional>
#include <iterator>
#include <new>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class PosterQueueTest : public testing::Test {
 protected:
  ~PosterQueueTest() override {
    workers_.stop();
    workers_.join();
  }

  // Adds the models. Returns once the queue is empty and no attempt is to be repeated.
  void make(const std::vector<ModelId>& models) {
    for (const ModelId& model : models)
      queue_.add(model);
    io_.run();
    io_.restart();
  }
  std::string log() {
    std::ifstream in(folder_.path() / "log");
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const ModelId one_ = ModelId::generate(), two_ = ModelId::generate(),
                three_ = ModelId::generate();
  std::function<Expected<void>(const ModelId&)> result_ = [](const ModelId&) {
    return Expected<void>();
  };
  std::vector<ModelId> attempts_;

 private:
  Expected<void> attempt(const ModelId& model) {
    EXPECT_EQ(++running_, 1);
    attempts_.push_back(model);
    struct End {
      std::atomic<int>& running;
      ~End() { --running; }
    } const end{running_};
    return result_(model);
  }

  test::TemporaryFolder folder_;
  const Log events_ = Log::open(folder_.path() / "log").value();
  asio::io_context io_;
  Workers workers_{{.threads = 3}};
  std::atomic<int> running_ = 0;
  PosterQueue queue_{workers_, io_, events_,
                     [this](const ModelId& model) { return attempt(model); },
                     std::chrono::milliseconds(0)};
};

TEST_F(PosterQueueTest, MakesOneModelAtATimeInTheOrderOfAdding) {
  make({one_, two_, three_});
  EXPECT_THAT(attempts_, ElementsAre(one_, two_, three_));
  EXPECT_THAT(log(), IsEmpty());
}

TEST_F(PosterQueueTest, AModelThatFailedIsTriedAgain) {
  bool is_reachable = false;
  result_ = [&](const ModelId&) -> Expected<void> {
    if (std::exchange(is_reachable, true)) return {};
    return fail(ErrorCode::kIo, "the bucket is away");
  };
  make({one_});
  EXPECT_THAT(attempts_, ElementsAre(one_, one_));
  EXPECT_THAT(log(), IsEmpty());
}

TEST_F(PosterQueueTest, AModelThatFailsThreeTimesIsLoggedAndLeftToVisitors) {
  result_ = [&](const ModelId& model) -> Expected<void> {
    if (model != two_) return {};
    return fail(ErrorCode::kState, "its file is damaged");
  };
  make({one_, two_, three_});
  EXPECT_EQ(std::ranges::count(attempts_, two_), 3);
  EXPECT_EQ(std::ranges::count(attempts_, three_), 1);
  EXPECT_EQ(attempts_.size(), 5u);
  EXPECT_THAT(log(), HasSubstr("model " + two_.to_string()));
  EXPECT_THAT(log(), HasSubstr("its file is damaged"));
}

TEST_F(PosterQueueTest, AnExceptionCountsAsAFailureAndStopsNoOtherModel) {
  result_ = [&](const ModelId& model) -> Expected<void> {
    if (model == one_) throw std::bad_alloc();
    return {};
  };
  make({one_, two_});
  EXPECT_EQ(std::ranges::count(attempts_, one_), 3);
  EXPECT_EQ(std::ranges::count(attempts_, two_), 1);
  EXPECT_THAT(log(), HasSubstr("bad_alloc"));
}

TEST_F(PosterQueueTest, ContinuesWithModelsThatAreAddedLater) {
  make({one_});
  make({two_});
  EXPECT_THAT(attempts_, ElementsAre(one_, two_));
}

}  // namespace
}  // namespace vitrine::server
