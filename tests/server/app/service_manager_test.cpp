// SPDX-License-Identifier: Apache-2.0
// Tests the real daemon's notifications to systemd. They must stop when the daemon is stuck.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "support/damage_object.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/served_folder.h"

namespace vitrine::test {
namespace {

using ::testing::StartsWith;
using namespace std::chrono_literals;

// Receives notifications as systemd does. A thread always receives, because the daemon would block
// if the socket's queue were full.
class ServiceManager {
 public:
  explicit ServiceManager(const std::filesystem::path& path)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot bind " + path.string());
    ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    ::setenv("WATCHDOG_USEC", "40000", 1);
    listener_ = std::thread([this] { listen(); });
  }
  ~ServiceManager() {
    ::unsetenv("NOTIFY_SOCKET");
    ::unsetenv("WATCHDOG_USEC");
    ::shutdown(socket_, SHUT_RD);
    listener_.join();
    ::close(socket_);
  }

  // Returns the next message that is not a watchdog message, or "nothing" if none arrives in time.
  std::string hear() {
    std::unique_lock lock(mutex_);
    if (!heard_.wait_for(lock, kTimeout, [this] { return !messages_.empty(); })) return "nothing";
    std::string message = std::move(messages_.front());
    messages_.pop_front();
    return message;
  }

  // Returns whether the daemon is still sending watchdog messages. Waits for more messages than can
  // have been in transit before the call.
  bool hears_of_life() {
    std::unique_lock lock(mutex_);
    const std::uint64_t before = alive_;
    return heard_.wait_for(lock, kTimeout, [&] { return alive_ > before + kUnderWay; });
  }

  // Returns whether no watchdog message arrives for a second, which is 50 times the daemon's
  // interval. Ignores up to kUnderWay messages that were already in transit.
  bool hears_no_more() {
    std::unique_lock lock(mutex_);
    const std::uint64_t before = alive_;
    for (std::uint64_t last = before; last <= before + kUnderWay; last = alive_) {
      if (!heard_.wait_for(lock, 1s, [&] { return alive_ > last; })) return true;
    }
    return false;
  }

 private:
  static constexpr auto kTimeout = 20s;
  static constexpr std::uint64_t kUnderWay = 30;  // largest number of messages in transit

  void listen() {
    char text[512];
    for (ssize_t length; (length = ::recv(socket_, text, sizeof text, 0)) > 0;) {
      const std::string message(text, static_cast<std::size_t>(length));
      const std::scoped_lock lock(mutex_);
      if (message == "WATCHDOG=1") {
        ++alive_;
      } else {
        messages_.push_back(message);
      }
      heard_.notify_all();
    }
  }

  const int socket_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable heard_;
  std::deque<std::string> messages_;
  std::uint64_t alive_ = 0;
  std::thread listener_;
};

class ServiceManagerTest : public ::testing::Test {
 protected:
  ServedFolder served;
  ServiceManager manager{served.path() / "notify"};
};

TEST_F(ServiceManagerTest, HearsWhenTheDaemonIsReadyReloadsLivesAndStops) {
  Daemon daemon(served.path());
  EXPECT_EQ(manager.hear(), "READY=1");
  EXPECT_TRUE(manager.hears_of_life());
  daemon.signal(SIGHUP);
  EXPECT_THAT(manager.hear(), StartsWith("RELOADING=1\nMONOTONIC_USEC="));
  EXPECT_EQ(manager.hear(), "READY=1");
  EXPECT_TRUE(manager.hears_of_life());
  daemon.signal(SIGTERM);
  EXPECT_EQ(manager.hear(), "STOPPING=1");
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

// Returns the only file below the folder.
std::filesystem::path file_in(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) return entry.path();
  }
  throw std::runtime_error("no file in " + folder.string());
}

TEST_F(ServiceManagerTest, HearsOfADaemonThoughManyVisitorsWaitForOneModel) {
  const std::string model = "/api/v1/models/" + served.publish("Bust");
  const auto object = file_in(served.path() / "objects");
  const auto aside = served.path() / "aside", pipe = served.path() / "pipe";
  std::filesystem::rename(object, aside);
  // Replaces the object by a FIFO. A thread that opens the FIFO blocks until the test opens the
  // other end.
  ASSERT_EQ(::mkfifo(object.c_str(), 0600), 0);
  Daemon daemon(served.path(), {"--scrub-rate", "0"});
  EXPECT_EQ(manager.hear(), "READY=1");
  std::vector<std::unique_ptr<HttpClient>> visitors;
  const auto visit = [&] {
    visitors.push_back(std::make_unique<HttpClient>(daemon.port()));
    visitors.back()->send("GET " + model + "/manifest HTTP/1.1\r\nHost: a\r\n\r\n");
  };
  visit();
  while (http_get(daemon.admin_port(), "/metrics").body.find("cache_misses_total 1\n") ==
         std::string::npos)
    std::this_thread::yield();  // waits until a thread opens the object
  for (int i = 0; i < 40; ++i)  // more requests for this model than the daemon has workers
    visit();
  EXPECT_EQ(http_get(daemon.port(), "/api/v1/models").status, 200) << "a worker answers";
  EXPECT_TRUE(manager.hears_of_life());
  std::filesystem::rename(object, pipe);
  std::filesystem::rename(aside, object);
  ::close(::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  for (const auto& visitor : visitors)
    EXPECT_EQ(visitor->receive().status, 200);
  EXPECT_TRUE(manager.hears_of_life());
}

TEST_F(ServiceManagerTest, HearsNoMoreOfADaemonWhoseWorkersAreAllStuck) {
  constexpr int kVisitors = 40, kRequests = 20;
  const std::string model = "/api/v1/models/" + served.publish("Bust");
  damage_object(served.path(), sha256(served_pmesh().bytes));
  Daemon daemon(served.path(), {"--scrub-rate", "0", "--export-cache", "0", "--request-rate", "0",
                                "--threads", "2", "--trusted-proxies", "127.0.0.1"});
  EXPECT_EQ(manager.hear(), "READY=1");
  std::vector<std::unique_ptr<HttpClient>> visitors;
  for (int i = 0; i < kVisitors; ++i) {  // from many addresses, because each may use few workers
    visitors.push_back(std::make_unique<HttpClient>(daemon.port()));
    for (int j = 0; j < kRequests; ++j)
      visitors.back()->send("GET " + model + "/manifest HTTP/1.1\r\nHost: a\r\n" +
                            "X-Forwarded-For: 192.0.2." + std::to_string(i) + "\r\n\r\n");
  }
  EXPECT_TRUE(manager.hears_no_more()) << "nobody reads the messages of the workers";
  EXPECT_EQ(http_get(daemon.admin_port(), "/livez").status, 200) << "the network still answers";
  for (int i = 0; i < kVisitors * kRequests; ++i)
    daemon.wait_for_line("event=error");
  EXPECT_TRUE(manager.hears_of_life());
}

TEST_F(ServiceManagerTest, HearsNoMoreOfADaemonWhoseNetworkThreadsAreStuck) {
  const auto log = served.path() / "access.log";
  ASSERT_EQ(::mkfifo(log.c_str(), 0600), 0);
  const int pipe = ::open(log.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ::fcntl(pipe, F_SETFL, 0);
  ::fcntl(pipe, F_SETPIPE_SZ, 4096);
  std::optional<Daemon> daemon(std::in_place, served.path());
  EXPECT_EQ(manager.hear(), "READY=1");
  EXPECT_TRUE(manager.hears_of_life());
  std::string requests;
  for (int i = 0; i < 500; ++i)
    requests += "HEAD /nothing HTTP/1.1\r\nHost: a\r\n\r\n";
  HttpClient first(daemon->port()), second(daemon->port());
  for (HttpClient* visitor : {&first, &second})
    visitor->send(requests);
  EXPECT_TRUE(manager.hears_no_more()) << "nobody reads the log";
  std::thread reader([&] {
    char text[4096];
    while (::read(pipe, text, sizeof text) > 0) {
    }
  });
  EXPECT_TRUE(manager.hears_of_life());
  daemon.reset();
  reader.join();
  ::close(pipe);
}

}  // namespace
}  // namespace vitrine::test
