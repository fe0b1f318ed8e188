// SPDX-License-Identifier: Apache-2.0
#include "server/app/streams.h"

#include "server/config/networks.h"
#include "server/http/published.h"
#include "server/stream/websocket.h"

namespace vitrine {
namespace {

// One of the streams that are open, as long as it lives.
class Counted {
 public:
  explicit Counted(Metrics& metrics) : metrics_(metrics) {
    metrics_.streams.fetch_add(1, std::memory_order_relaxed);
  }
  ~Counted() { metrics_.streams.fetch_sub(1, std::memory_order_relaxed); }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;

 private:
  Metrics& metrics_;
};

// Who asks, and what for; copied by what outlives the call.
struct Asker {
  StreamHost host;
  std::string address, request_id;
  std::optional<Caller> caller;

  bool may_ask() const {
    return host.rate_limit.take(network_of(address)).count() == 0 &&
           (!caller || host.rate_limit.take(caller->token.to_string()).count() == 0);
  }
};

// With a token that may have been revoked since.
FoundModel look_up(const Asker& asker, const ModelId& id) {
  Services& services = asker.host.services;
  Expected<bool> has_token = false;
  if (asker.caller) has_token = services.tokens.is_in_force(*asker.caller);
  if (!has_token) return Unexpected(has_token.error());
  return find_visible(id, *has_token, services.models).model;
}

Expected<StreamedModel> find_now(const Asker& asker, const ModelId& id) {
  FoundModel model = look_up(asker, id);
  if (!model) {
    asker.host.services.errors.event(Severity::kError,
                                     "request " + asker.request_id + ": " + model.error().message);
    return fail(ErrorCode::kIo, "the server cannot look it up; try again later");
  }
  if (!*model) return fail(ErrorCode::kBadInput, "there is no such model");
  return model;
}

asio::awaitable<Expected<StreamedModel>> find(const Asker& asker, const ModelId& id) {
  auto work = [&]() -> asio::awaitable<Expected<StreamedModel>> { co_return find_now(asker, id); };
  co_return co_await asio::co_spawn(asker.host.workers.executor(Place::kWorker, ""), work,
                                    asio::use_awaitable);
}

asio::awaitable<Expected<StreamedModel>> find_further(const Asker& asker, std::string text) {
  if (!asker.may_ask()) co_return fail(ErrorCode::kState, "too many requests; wait");
  const auto id = ModelId::parse(text);
  if (!id) co_return fail(ErrorCode::kBadInput, "there is no such model");
  co_return co_await find(asker, *id);
}

// Most visitors are answered from memory.
asio::awaitable<bool> is_current(const Asker& asker, StreamedModel model) {
  const ModelRecord& opened = model->record();
  if (!asker.caller && asker.host.services.models.held(opened.id) == model) co_return true;
  const auto now = co_await find(asker, opened.id);
  co_return now && (*now)->record().file == opened.file;
}

StreamOptions options_of(const StreamCall& call, const Asker& asker) {
  const auto connection = call.connection;
  Services& services = asker.host.services;
  const std::chrono::seconds patience = services.settings.get()->idle_timeout;
  StreamOptions options;
  options.patience = patience;
  options.head = call.head;
  options.is_direct = !services.settings.get()->trusted_proxies.contain(connection->remote);
  options.find = [asker](std::string id) { return find_further(asker, std::move(id)); };
  options.is_current = [asker](StreamedModel model) { return is_current(asker, std::move(model)); };
  options.waits_for_peer = [connection, patience](bool waits) {
    waits ? connection->expires_after(patience) : connection->never_expires();
  };
  options.on_drain = [connection](std::function<void()> stop) {
    if (connection->draining) stop();
    connection->on_drain = std::move(stop);
  };
  options.sent = [&services](std::uint64_t bytes) {
    services.metrics.stream_bytes.fetch_add(bytes, std::memory_order_relaxed);
  };
  options.failed = [&services, id = asker.request_id](std::string_view fault) {
    services.errors.event(Severity::kError, "stream " + id + ": " + std::string(fault));
  };
  return options;
}

}  // namespace

asio::awaitable<void> stream(StreamCall call, StreamHost host) {
  const Asker asker{host, call.address, call.request_id, call.caller};
  const auto model = co_await find(asker, call.model);
  if (!model) co_return;  // it was there when the request was answered
  const Counted counted(host.services.metrics);
  const auto connection = call.connection;
  co_await serve_stream({connection, &connection->socket}, std::move(call.request), *model,
                        options_of(call, asker), host.crowd);
  connection->on_drain = nullptr;
}

}  // namespace vitrine
