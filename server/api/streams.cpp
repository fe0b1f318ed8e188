// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <mutex>

#include "server/api/handlers.h"
#include "server/api/published.h"
#include "server/config/networks.h"
#include "server/http/http_server.h"
#include "server/http/upgrade.h"
#include "server/messages/origin.h"
#include "server/messages/query.h"
#include "server/stream/stream_session.h"

namespace vitrine::server {
namespace {

using beast::http::field;

Response upgrade_required(std::string_view request_id) {
  Response response = problem(426, "connect with WebSocket, subprotocol pmesh.v1", request_id);
  response.fields = {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}};
  return response;
}

// Reads the query parameter `head`: whether to send the model's head (Manifest::head_bytes())
// first. Returns false if the parameter is absent, nullopt if the query is invalid.
std::optional<bool> head_in(std::string_view text) {
  constexpr std::string_view kKnown[] = {"head"};
  const auto query = Query::parse(text);
  if (!query || query->unknown(kKnown)) return std::nullopt;
  const std::string_view head = query->get("head").value_or("false");
  if (head != "true" && head != "false") return std::nullopt;
  return head == "true";
}

bool offers_protocol(const RequestHeader& header) {
  return beast::http::token_list(header[field::sec_websocket_protocol]).exists("pmesh.v1");
}

// Counts one open stream in the metrics until this object is destroyed.
class OpenStream {
 public:
  explicit OpenStream(Metrics& metrics) : metrics_(metrics) {
    metrics_.streams.fetch_add(1, std::memory_order_relaxed);
  }
  ~OpenStream() { metrics_.streams.fetch_sub(1, std::memory_order_relaxed); }
  OpenStream(const OpenStream&) = delete;
  OpenStream& operator=(const OpenStream&) = delete;

 private:
  Metrics& metrics_;
};

// The client of a stream: its address, the ID of its request, and the owner of its token.
struct StreamClient {
  std::string address, request_id;
  std::optional<Caller> caller;

  bool may_ask(RateLimit& limit) const {
    return limit.take(network_of(address)).count() == 0 &&
           (!caller || limit.take(caller->token.to_string()).count() == 0);
  }
};

// Whether a stream may continue with the model `opened`: the client may still see the model, and
// the model's file was neither replaced nor found damaged since. `now` is the result of a new
// lookup.
bool is_current(const PublishedModel& opened, const FoundModel& now) {
  return now && *now && (*now)->record().file == opened.record().file &&
         (*now)->damages() == opened.damages();
}

// The models that one stream has open. Thread-safe.
class OpenModels {
 public:
  void set(std::vector<StreamedModel> models) {
    const std::scoped_lock lock(mutex_);
    models_ = std::make_shared<const Models>(std::move(models));
    checked_.reset();
  }

  // Whether all models are current. Returns true at once if no model has changed and no file was
  // found damaged since the last call. Opens no file, because hashing or fetching it may take long,
  // and other streams wait for the same thread. If the catalogue cannot be read, a model counts as
  // current, because the cache still serves it; the next call checks it again.
  bool are_current(bool has_token, PublishedModels& cache) {
    const auto revision = cache.revision();
    if (!revision) return true;
    const auto models = unchecked(*revision);
    if (!models) return true;
    bool are_all_known = true;
    for (const StreamedModel& model : *models) {
      const ModelRecord& opened = model->record();
      if (cache.damages_of(opened.file) != model->damages()) return false;
      const auto file = cache.file_of(opened.id, has_token);
      if (file && *file != opened.file) return false;
      if (!file) are_all_known = false;
    }
    if (are_all_known) set_checked(models, *revision);
    return true;
  }

 private:
  using Models = std::vector<StreamedModel>;

  // Returns the open models, or null if they were already checked at this revision.
  std::shared_ptr<const Models> unchecked(const ModelsRevision& revision) {
    const std::scoped_lock lock(mutex_);
    return checked_ == revision ? nullptr : models_;
  }
  // Records that `models` were checked at this revision. Has no effect if the stream has
  // opened or closed a model since unchecked().
  void set_checked(const std::shared_ptr<const Models>& models, const ModelsRevision& revision) {
    const std::scoped_lock lock(mutex_);
    if (models == models_) checked_ = revision;
  }

  std::mutex mutex_;  // guards the members below
  std::shared_ptr<const Models> models_ = std::make_shared<const Models>();
  std::optional<ModelsRevision> checked_;  // revision at the last complete check
};

// Connects one stream to the rest of the daemon. Looks up models on a worker thread. Each `open`
// message counts towards the client's request rate.
class ModelStreamHost : public StreamHost {
 public:
  ModelStreamHost(std::shared_ptr<Connection> connection, const StreamClient& client,
                  OpenModels& open, Services& services, HttpServer& server)
      : connection_(std::move(connection)),
        client_(client),
        open_(open),
        services_(services),
        server_(server) {}
  ~ModelStreamHost() override { connection_->on_drain = nullptr; }

  asio::awaitable<Expected<StreamedModel>> find(std::string text) override {
    if (!client_.may_ask(server_.rate_limit()))
      co_return fail(ErrorCode::kState, "too many requests; wait");
    const auto id = ModelId::parse(text);
    if (!id) co_return fail(ErrorCode::kBadInput, "there is no such model");
    co_return co_await find_on_worker(*id);
  }

  // Uses only the cache of models if the cache is up to date. Otherwise reads the catalogue on a
  // worker thread.
  asio::awaitable<bool> is_current(StreamedModel model) override {
    const ModelRecord& opened = model->record();
    if (!client_.caller && cached_visible(opened.id, false, services_.models) == model)
      co_return true;
    if (services_.models.damages_of(opened.file) != model->damages()) co_return false;
    co_return server::is_current(*model, co_await find_on_worker(opened.id));
  }

  void shows(std::vector<StreamedModel> models) override { open_.set(std::move(models)); }

  void on_drain(std::function<void()> stop) override {
    if (connection_->is_draining) stop();
    connection_->on_drain = std::move(stop);
  }

  void waits_for_peer(bool waits) override {
    waits ? connection_->expires_after(server_.pace().timeout) : connection_->never_expires();
  }

  void sent(std::uint64_t bytes) override {
    services_.metrics.stream_bytes.fetch_add(bytes, std::memory_order_relaxed);
  }

  void failed(std::string_view fault) override {
    services_.errors.event(Severity::kError,
                           "stream " + client_.request_id + ": " + std::string(fault));
  }

 private:
  asio::awaitable<Expected<StreamedModel>> find_on_worker(ModelId id) {
    Workers& workers = server_.workers();
    std::string owner =
        client_.caller ? client_.caller->token.to_string() : network_of(client_.address);
    const auto look = [&] { return opening_of(id, client_.caller.has_value(), services_.models); };
    auto opening = co_await workers.run(Executor::kWorker, owner, "", look);
    if (opening) co_await workers.open(owner, std::move(*opening));
    co_return co_await workers.run(Executor::kWorker, owner, "", [&] { return find_now(id); });
  }

  Expected<StreamedModel> find_now(const ModelId& id) {
    FoundModel model = look_up(id);
    if (!model) {
      services_.errors.event(Severity::kError,
                             "request " + client_.request_id + ": " + model.error().message);
      return fail(ErrorCode::kIo, "the server cannot look it up; try again later");
    }
    if (!*model) return fail(ErrorCode::kBadInput, "there is no such model");
    return model;
  }

  // Checks the client's token again, because it may have been revoked since the connection began.
  FoundModel look_up(const ModelId& id) {
    Expected<bool> has_token = false;
    if (client_.caller) has_token = services_.tokens.is_in_force(*client_.caller);
    if (!has_token) return tl::unexpected(has_token.error());
    return find_visible(id, *has_token, services_.models).model;
  }

  const std::shared_ptr<Connection> connection_;
  const StreamClient& client_;
  OpenModels& open_;
  Services& services_;
  HttpServer& server_;
};

class StreamUpgrade : public Upgrade {
 public:
  StreamUpgrade(StreamedModel model, StreamClient client, bool sends_head, Services& services)
      : model_(std::move(model)),
        client_(std::move(client)),
        sends_head_(sends_head),
        services_(services) {}

  asio::awaitable<void> serve(UpgradedConnection upgraded, HttpServer& server) override {
    const OpenStream counted(services_.metrics);
    const auto connection = std::move(upgraded.connection);
    ModelStreamHost host(connection, client_, open_, services_, server);
    const StreamOptions options = {
        .timeout = server.pace().timeout,
        .sends_head = sends_head_,
        .is_direct = !services_.settings.get().trusted_proxies.contain(connection->remote)};
    const std::shared_ptr<ByteStream> socket(connection, &connection->socket);
    co_await serve_stream(socket, std::move(upgraded.request), std::move(model_), options, host,
                          services_.busy_streams);
  }

  bool may_continue() override {
    return open_.are_current(client_.caller.has_value(), services_.models);
  }

 private:
  StreamedModel model_;
  const StreamClient client_;
  OpenModels open_;
  const bool sends_head_;
  Services& services_;
};

}  // namespace

static Response open_stream(const Request& request, Services& services) {
  if (!beast::websocket::is_upgrade(request.header)) return upgrade_required(request.id);
  if (!offers_protocol(request.header)) {
    return problem(400, "request the subprotocol pmesh.v1", request.id);
  }
  const auto sends_head = head_in(request.query);
  if (!sends_head) return problem(400, "head is true or false", request.id);
  if (!is_allowed_origin(request.header, services.settings.get().allowed_origins)) {
    return problem(403, "pages of this origin may not open streams here", request.id);
  }
  return with_model(request, services, [&](const auto& model) {
    StreamClient client{.address = std::string(request.client_address),
                        .request_id = std::string(request.id),
                        .caller = request.caller};
    Response response;
    response.status = 101;
    response.upgrade =
        std::make_shared<StreamUpgrade>(model, std::move(client), *sends_head, services);
    return response;
  });
}

static constexpr ApiRoute kStreamRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/models/{id}/stream",
     .handler = open_stream,
     .executor = Executor::kWorker,
     .doc = {.id = "openStream",
             .summary = "Upgrades the connection to a WebSocket (subprotocol `pmesh.v1`, see "
                        "server/stream/PROTOCOL.md).",
             .status = 101}},
};

const ApiNoun kStreams = {.routes = kStreamRoutes};

}  // namespace vitrine::server
