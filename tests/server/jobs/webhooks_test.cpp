// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/webhooks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <string>

#include "server/remote/remote_server.h"
#include "support/webhook_listener.h"

namespace vitrine::server {
namespace {

using test::WebhookListener;
using testing::HasSubstr;

const auto kMay = [] { return true; };

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
  hooks.call(url_of(listener), R"({"state":"done"})", kMay, [&] { done.set_value(); });
  const std::string first = listener.hear("503 Busy");
  EXPECT_THAT(first, HasSubstr("POST /told HTTP/1.1\r\n"));
  EXPECT_THAT(first, HasSubstr("Content-Type: application/json\r\n"));
  EXPECT_TRUE(first.ends_with("\r\n\r\n{\"state\":\"done\"}"));
  EXPECT_EQ(listener.hear("204 Taken"), first);
  done.get_future().wait();
  hooks.call(url_of(listener, "/next"), "{}", kMay, [] {});
  EXPECT_THAT(listener.hear("200 OK"), HasSubstr("POST /next"));
}

TEST(Webhooks, AWaitingMessageIsPostedOnceAndNotAfterAnotherDaemonHasDoneSo) {
  const Log log = Log::open("").value();
  WebhookListener listener;
  Webhooks hooks({listener.host()}, log);
  std::promise<void> go;
  hooks.call(
      url_of(listener, "/first"), "{}",
      [until = go.get_future().share()] {
        until.wait();
        return true;
      },
      [] {});
  for (int claimed = 0; claimed < 2; ++claimed)
    hooks.call(url_of(listener, "/waits"), "{}", kMay, [] {});
  hooks.call(
      url_of(listener, "/told"), "{}", [] { return false; }, [] {});
  hooks.call(url_of(listener, "/last"), "{}", kMay, [] {});
  go.set_value();
  for (const char* path : {"/first", "/waits", "/last"})
    EXPECT_THAT(listener.hear("200 OK"), HasSubstr(std::string("POST ") + path + " "));
}

TEST(Webhooks, AServerThatDoesNotRespondDelaysNoOther) {
  const Log log = Log::open("").value();
  WebhookListener dead, other;
  std::atomic<bool> given_up = false;
  Webhooks hooks({dead.host(), other.host()}, log);
  hooks.call(url_of(dead), "{}", kMay, [&] { given_up = true; });
  std::string request;
  const FileDescriptor peer = dead.accept(request);
  hooks.call(url_of(other), "{}", kMay, [] {});
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
    hooks.call(url_of(listener), std::to_string(i), kMay, [&] { ++done; });
  listener.hear("500 No");
  hooks.stop();  // the remaining calls are not tried
  EXPECT_EQ(done, 0);
}

}  // namespace
}  // namespace vitrine::server
