// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhooks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <future>
#include <set>
#include <string>

#include "server/config/options.h"
#include "server/jobs/clock.h"
#include "server/jobs/webhook_signature.h"
#include "server/remote/remote_server.h"
#include "support/webhook_listener.h"

namespace vitrine::server {
namespace {

using test::WebhookListener;
using testing::HasSubstr;
using testing::Not;

const auto kMay = [] { return true; };

WebhookMessage message(const std::string& url, const std::string& json, std::function<void()> done,
                       std::function<bool()> may = kMay) {
  return {.url = url, .id = "msg_1", .json = json, .may = std::move(may), .done = std::move(done)};
}

std::string url_of(const WebhookListener& listener, const std::string& path = "/told") {
  return "http://" + listener.host() + path;
}

TEST(Webhooks, OnlyHostsThatAreNamedAreCalled) {
  const Log log = Log::open("").value();
  const Webhooks hooks({"museum.example", "127.0.0.1:81"}, log);
  EXPECT_TRUE(hooks.allows("https://museum.example/told?x=1"));
  EXPECT_TRUE(hooks.allows("http://127.0.0.1:81"));
  for (const char* url : {"http://127.0.0.1/", "http://127.0.0.1:810/", "http://localhost:81/",
                          "http://museum.example@evil.example/", "http://museum.example.evil/",
                          "http://evil.example/?http://museum.example/", "file:///etc/passwd",
                          "http://[::1]:81/", "gopher://museum.example/", "http://", ""})
    EXPECT_FALSE(hooks.allows(url)) << url;
  EXPECT_FALSE(Webhooks({}, log).allows("http://museum.example/"));
}

TEST(Webhooks, AreRetriedUntilTheyAreAccepted) {
  const Log log = Log::open("").value();
  WebhookListener listener;
  std::promise<void> done;
  Webhooks hooks({listener.host()}, log);
  hooks.call(message(url_of(listener), R"({"state":"done"})", [&] { done.set_value(); }));
  const std::string first = listener.hear("503 Busy");
  EXPECT_THAT(first, HasSubstr("POST /told HTTP/1.1\r\n"));
  EXPECT_THAT(first, HasSubstr("Content-Type: application/json\r\n"));
  EXPECT_TRUE(first.ends_with("\r\n\r\n{\"state\":\"done\"}"));
  EXPECT_EQ(listener.hear("204 Taken"), first);
  done.get_future().wait();
  hooks.call(message(url_of(listener, "/next"), "{}", [] {}));
  EXPECT_THAT(listener.hear("200 OK"), HasSubstr("POST /next"));
}

TEST(Webhooks, AWaitingMessageIsPostedOnceAndNotAfterAnotherDaemonHasDoneSo) {
  const Log log = Log::open("").value();
  WebhookListener listener;
  Webhooks hooks({listener.host()}, log);
  std::promise<void> go;
  const auto wait = [until = go.get_future().share()] {
    until.wait();
    return true;
  };
  hooks.call(message(
      url_of(listener, "/first"), "{}", [] {}, wait));
  for (int claimed = 0; claimed < 2; ++claimed)
    hooks.call(message(url_of(listener, "/waits"), "{}", [] {}));
  hooks.call(message(
      url_of(listener, "/told"), "{}", [] {}, [] { return false; }));
  hooks.call(message(url_of(listener, "/last"), "{}", [] {}));
  go.set_value();
  for (const char* path : {"/first", "/waits", "/last"})
    EXPECT_THAT(listener.hear("200 OK"), HasSubstr(std::string("POST ") + path + " "));
}

// The example comes from the test suite of the Standard Webhooks specification.
TEST(Webhooks, AreSignedAsTheSpecificationSays) {
  Settings settings;
  ASSERT_TRUE(
      find_option("webhook-secret")->apply(settings, "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"));
  const auto fields = signature_fields(settings.webhook_key, "msg_p5jXN8AQM9LWM0D4loKWxJek",
                                       1614265330, R"({"test": 2432232314})");
  EXPECT_THAT(fields,
              testing::ElementsAre(
                  "webhook-id: msg_p5jXN8AQM9LWM0D4loKWxJek", "webhook-timestamp: 1614265330",
                  "webhook-signature: v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE="));
}

// A receiver that verifies calls as server/README.md describes.
class Receiver {
 public:
  explicit Receiver(std::string key) : key_(std::move(key)) {}

  bool takes(const std::string& request, std::int64_t now) {
    constexpr std::int64_t kOldest = 300;
    const std::string id = field(request, "webhook-id"), time = field(request, "webhook-timestamp");
    if (id.empty() || time.empty()) return false;
    const std::int64_t seconds = std::stoll(time);
    const std::string body = request.substr(request.find("\r\n\r\n") + 4);
    const auto genuine = signature_fields(key_, id, seconds, body);
    const bool is_genuine =
        genuine[2] == "webhook-signature: " + field(request, "webhook-signature");
    return is_genuine && std::abs(now - seconds) <= kOldest && taken_.insert(id).second;
  }

 private:
  static std::string field(const std::string& request, const std::string& name) {
    const std::size_t at = request.find("\r\n" + name + ": ");
    if (at == request.npos) return {};
    const std::size_t begin = at + name.size() + 4;
    return request.substr(begin, request.find("\r\n", begin) - begin);
  }

  const std::string key_;
  std::set<std::string> taken_;
};

std::string changed(std::string request, const std::string& from, const std::string& to) {
  const std::size_t at = request.find(from);
  EXPECT_NE(at, request.npos) << from;
  return request.replace(at, from.size(), to);
}

TEST(Webhooks, AReceiverRefusesForgedAndRepeatedMessages) {
  const Log log = Log::open("").value();
  const std::string key = "a key of thirty-two bytes, as is";
  WebhookListener listener;
  Webhooks hooks({listener.host()}, log, key);
  hooks.call(message(url_of(listener), R"({"state":"done"})", [] {}));
  const std::string lost = listener.hear("503 Busy"), again = listener.hear("200 OK");
  const std::int64_t now = now_in_milliseconds() / 1000;
  const std::string forged = changed(again, "\"done\"", "\"fine\"");
  EXPECT_FALSE(Receiver(key).takes(forged, now));
  EXPECT_FALSE(Receiver(key).takes(changed(again, "webhook-id: msg_1", "webhook-id: msg_2"), now));
  EXPECT_FALSE(
      Receiver(key).takes(changed(again, "webhook-timestamp: ", "webhook-timestamp: 1"), now));
  EXPECT_FALSE(Receiver("a key of another server, of bytes").takes(again, now));
  Receiver receiver(key);
  EXPECT_FALSE(receiver.takes(again, now + 3'600)) << "an old message";
  EXPECT_TRUE(receiver.takes(again, now));
  EXPECT_FALSE(receiver.takes(again, now)) << "a message that was taken before";
  EXPECT_FALSE(receiver.takes(lost, now)) << "an earlier try of the same message";
}

TEST(Webhooks, WithoutAKeyAreNotSigned) {
  const Log log = Log::open("").value();
  WebhookListener listener;
  Webhooks hooks({listener.host()}, log);
  hooks.call(message(url_of(listener), "{}", [] {}));
  EXPECT_THAT(listener.hear("200 OK"), Not(HasSubstr("webhook-signature")));
}

TEST(Webhooks, AServerThatDoesNotRespondDelaysNoOther) {
  const Log log = Log::open("").value();
  WebhookListener dead, other;
  std::atomic<bool> given_up = false;
  Webhooks hooks({dead.host(), other.host()}, log);
  hooks.call(message(url_of(dead), "{}", [&] { given_up = true; }));
  std::string request;
  const FileDescriptor peer = dead.accept(request);
  hooks.call(message(url_of(other), "{}", [] {}));
  EXPECT_THAT(other.hear("200 OK"), HasSubstr("POST /told"));
  EXPECT_FALSE(given_up);
  hooks.stop();
  EXPECT_FALSE(given_up) << "it is for the next daemon to tell";
}

TEST(Webhooks, ARequestThatIsGivenUpEnds) {
  WebhookListener dead;
  RemoteServer server;
  const auto answer = server.ask({.url = url_of(dead), .given_up = [] { return true; }});
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().message, HasSubstr("aborted"));
}

TEST(Webhooks, DoNotDelayTheEnd) {
  const Log log = Log::open("").value();
  WebhookListener listener;
  std::atomic<int> done = 0;
  Webhooks hooks({listener.host()}, log);
  for (int i = 0; i < 10; ++i)
    hooks.call(message(url_of(listener), std::to_string(i), [&] { ++done; }));
  listener.hear("500 No");
  hooks.stop();  // cancels the remaining calls
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace vitrine::server
