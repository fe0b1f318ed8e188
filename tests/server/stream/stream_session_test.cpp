// SPDX-License-Identifier: Apache-2.0
// Tests how a connection ends if something throws, as if memory ran out, or if its model is no
// longer current. The connection must leave nothing behind.
#include "server/stream/stream_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/use_future.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/read.hpp>
#include <future>
#include <thread>

#include "server/store/installation.h"
#include "server/store/publish.h"
#include "server/transport/tls_context.h"
#include "support/process/certificate.h"
#include "support/process/http_client.h"
#include "support/process/tls_client.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

// A host that throws when a model is looked up. It also throws after a slice is sent if the test
// sets throws_on_sent.
class TestHost : public StreamHost {
 public:
  asio::awaitable<Expected<StreamedModel>> find(std::string) override {
    throw std::bad_alloc();
    co_return StreamedModel();
  }
  asio::awaitable<bool> is_current(StreamedModel) override { co_return has_current_model; }
  void shows(std::vector<StreamedModel> models) override { shown = models.size(); }
  void on_drain(std::function<void()>) override {}
  void waits_for_peer(bool) override {}
  void sent(std::uint64_t bytes) override {
    sent_bytes += bytes;
    if (throws_on_sent) throw std::bad_alloc();
  }
  void failed(std::string_view fault) override { faults.emplace_back(fault); }

  bool throws_on_sent = false;
  std::atomic<bool> has_current_model = true;
  std::size_t shown = 0;         // number of models that are open
  std::uint64_t sent_bytes = 0;  // sum of all slices
  std::vector<std::string> faults;
};

// Serves one connection, with TLS if the parameter is true.
class WebsocketTest : public ::testing::TestWithParam<bool> {
 protected:
  WebsocketTest() { options.timeout = std::chrono::seconds(1); }
  ~WebsocketTest() override {
    io.stop();
    if (thread.joinable()) thread.join();
  }

  // Connects and returns the client after it has received the server's greeting.
  WebSocketClient connect() {
    if (GetParam()) {
      const TlsFiles files{folder.path() / "chain.pem", folder.path() / "key.pem"};
      write_certificate(make_certificate("A museum"), files.certificate, files.key);
      tls = TlsContext::load(files).value();
    }
    ended = asio::co_spawn(io, serve(), asio::use_future);
    thread = std::thread([this] { io.run(); });
    const std::uint16_t port = acceptor.local_endpoint().port();
    auto http = GetParam() ? std::make_unique<TlsClient>(port) : std::make_unique<HttpClient>(port);
    WebSocketClient client(std::move(http), "/", "pmesh.v1");
    EXPECT_EQ(client.receive().kind, WebSocketFrame::kText);
    return client;
  }

  // Expects that serve_stream() has returned and released the socket, and that these faults were
  // reported to the host.
  void expect_end(const std::vector<std::string>& faults) {
    ASSERT_EQ(ended.wait_for(std::chrono::seconds(20)), std::future_status::ready);
    EXPECT_NO_THROW(ended.get());
    io.stop();
    thread.join();
    EXPECT_TRUE(socket.expired());
    EXPECT_EQ(host.faults, faults);
  }

  StreamOptions options;
  TestHost host;
  const std::vector<std::string> no_memory{std::bad_alloc().what()};

 private:
  asio::awaitable<void> serve() {
    auto stream = std::make_shared<ByteStream>(
        ByteStream::Socket(co_await acceptor.async_accept(asio::use_awaitable)));
    socket = stream;
    if (tls) co_await stream->encrypt(tls);
    beast::flat_buffer buffer;
    beast::http::request<beast::http::string_body> request;
    co_await beast::http::async_read(*stream, buffer, request, asio::use_awaitable);
    co_await serve_stream(std::move(stream), std::move(request), model, options, host, busy);
  }

  const TemporaryFolder folder;
  const Installation installation = open_installation({.folder = folder.path()}).value();
  const StreamedModel model = [this] {
    const TinyPmesh pmesh = tiny_pmesh("a base mesh", "a chunk");
    const auto id = publish(*installation.store, *installation.catalogue, pmesh.bytes, {}).value();
    return PublishedModels(*installation.store, *installation.catalogue).find(id.id).value();
  }();
  BusyStreams busy;
  asio::io_context io;
  tcp::acceptor acceptor{io, {asio::ip::address_v4::loopback(), 0}};
  std::shared_ptr<const TlsContext> tls;
  std::weak_ptr<ByteStream> socket;
  std::future<void> ended;
  std::thread thread;
};

TEST_P(WebsocketTest, WhatIsThrownWhileReadingEndsTheConnection) {
  WebSocketClient client = connect();
  client.send_text(R"({"type":"open","model":1,"id":"x"})");
  EXPECT_EQ(client.receive().close_code(), 1011);
  client.send_close();
  expect_end(no_memory);
}

TEST_P(WebsocketTest, WhatIsThrownWhileWritingEndsTheConnection) {
  host.throws_on_sent = true;
  WebSocketClient client = connect();
  client.send_text(R"({"type":"want","level":1})");
  EXPECT_EQ(client.receive().kind, WebSocketFrame::kBinary);
  EXPECT_EQ(client.receive().close_code(), 1011);
  expect_end(no_memory);  // although this client never answers the close frame
}

TEST_P(WebsocketTest, ADetailRequestForAModelThatIsNoLongerCurrentEndsTheConnection) {
  WebSocketClient client = connect();
  host.has_current_model = false;
  client.send_text(R"({"type":"want","level":1})");
  const WebSocketFrame frame = client.receive();
  ASSERT_EQ(frame.kind, WebSocketFrame::kClose);
  EXPECT_EQ(frame.close_code(), 1012);
  client.send_close();
  expect_end({});
  EXPECT_EQ(host.sent_bytes, 0u);
  EXPECT_EQ(host.shown, 0u);
}

INSTANTIATE_TEST_SUITE_P(, WebsocketTest, ::testing::Bool(), [](const auto& tls) {
  return tls.param ? std::string("WithTls") : std::string("WithoutTls");
});

}  // namespace
}  // namespace vitrine::test
