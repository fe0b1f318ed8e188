// SPDX-License-Identifier: Apache-2.0
// Requests every route with every role, for each state of a scan's model. No response to a visitor
// may contain what the model hides. Prints the access matrix.
#include "server/api/visibility.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <unordered_set>

#include "server/api/routes.h"
#include "server/store/change.h"
#include "support/fake_backend.h"
#include "support/hierarchies.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/stored_model.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using Bytes = std::vector<std::uint8_t>;

std::string text_of(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

// Content that a visitor must not get. Stores a hash of every substring of kWindow bytes.
class Secrets {
 public:
  void hide(std::string_view content) {
    each_window(content, [&](std::size_t window) { windows_.insert(window); });
  }
  void reveal(std::string_view content) {
    each_window(content, [&](std::size_t window) { windows_.erase(window); });
  }
  bool are_in(std::string_view text) const {
    bool found = false;
    each_window(text, [&](std::size_t window) { found |= windows_.contains(window); });
    return found;
  }

 private:
  static constexpr std::size_t kWindow = 16;

  template <class Use>
  static void each_window(std::string_view text, const Use& use) {
    for (std::size_t i = 0; i + kWindow <= text.size(); ++i)
      use(std::hash<std::string_view>{}(text.substr(i, kWindow)));
  }

  std::unordered_set<std::size_t> windows_;
};

// The texts that replace the parameters of a route.
using Values = std::map<std::string, std::vector<std::string>, std::less<>>;

std::vector<std::string> expanded(const std::string& path, const Values& values) {
  const std::size_t open = path.find('{');
  if (open == std::string::npos) return {path};
  const std::size_t close = path.find('}', open);
  const auto found = values.find(path.substr(open + 1, close - open - 1));
  EXPECT_NE(found, values.end()) << path << ": add the new parameter to this test";
  std::vector<std::string> all;
  if (found == values.end()) return all;
  for (const std::string& value : found->second) {
    const auto paths = expanded(path.substr(0, open) + value + path.substr(close + 1), values);
    all.insert(all.end(), paths.begin(), paths.end());
  }
  return all;
}

// Returns the queries with which a route could reveal more than without a query.
std::vector<std::string> queries_of(std::string_view path, const std::string& model) {
  if (path.ends_with("/export.{format}")) return {"", "?level=highest"};
  if (path.ends_with("/manifest")) return {"", "?level=highest"};
  if (path.ends_with("/poster.png")) return {"?width=240"};
  if (path == "/api/v1/models") return {"", "?drafts=true"};
  if (path == "/api/v1/oembed") return {"?url=http://localhost/models/" + model};
  return {""};
}

std::vector<std::string> exports_of(const std::string& model) {
  const std::string path = "/api/v1/models/" + model;
  std::vector<std::string> paths = {path + "/poster.png?width=240"};
  for (const char* format : {"glb", "ply", "obj", "stl", "drc", "wrl", "3mf", "usdz", "obj.zip"})
    paths.push_back(path + "/export." + format);
  return paths;
}

// Returns the part of an export that tells the model's shape or look. For USDZ, returns only the
// list of positions, because the lists of indices look like lists in a manifest.
std::string_view telling_part(std::string_view path, std::string_view body) {
  if (!path.ends_with(".usdz")) return body;
  const std::size_t begin = body.find("point3f[] points"), end = body.find(']', begin + 16);
  EXPECT_NE(end, std::string_view::npos) << path;
  return begin == std::string_view::npos ? "" : body.substr(begin + 16, end - begin - 16);
}

// A server with a scan that became a public model, or a draft.
class World {
 public:
  explicit World(bool is_public) {
    EXPECT_TRUE(server.scans().start());
    const json started = json::parse(ask("POST", "/api/v1/scans", Role::kOperator,
                                         json{{"scanner", "rig"},
                                              {"steps", 12},
                                              {"metadata", {{"title", "A"}}},
                                              {"publish", is_public}}
                                             .dump())
                                         .body);
    scan = started.at("id");
    job = started.at("job");
    server.scans().jobs().executor("rig").run([] {});  // returns once the scan has ended
    model = json::parse(ask("GET", scan_path(), Role::kAdmin).body).at("model");
  }

  HttpAnswer ask(const std::string& method, const std::string& path, Role role,
                 const std::string& body = "") {
    test::HttpClient client(server.port());
    client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\n{}{}Content-Length: {}\r\n\r\n{}",
                            method, path, tokens[static_cast<std::size_t>(role)],
                            body.empty() ? "" : "Content-Type: application/json\r\n", body.size(),
                            body));
    HttpAnswer answer = client.receive();
    if (answer.field("content-type") != "text/event-stream") return answer;
    try {
      while (true)
        answer.body += client.read_exactly(1);
    } catch (const std::runtime_error&) {  // the connection has ended, as it should
    }
    return answer;
  }

  // Returns the bytes that a visitor receives by the stream, with the model's head.
  std::string streamed() {
    std::string bytes;
    try {
      test::WebSocketClient client(server.port(), model_path() + "/stream?head=true", "pmesh.v1");
      client.send_text(R"({"type":"ack","bytes":16777216})");
      client.send_text(R"({"type":"want","level":255})");
      for (auto frame = client.receive(); frame.kind != test::WebSocketFrame::kClose;
           frame = client.receive()) {
        if (frame.kind == test::WebSocketFrame::kBinary) bytes += frame.payload.substr(16);
        if (frame.payload.find(R"("done")") != std::string::npos) break;
      }
    } catch (const std::runtime_error&) {  // no such model for a visitor
    }
    return bytes;
  }

  std::string scan_path() const { return "/api/v1/scans/" + scan; }
  std::string model_path() const { return "/api/v1/models/" + model; }
  ModelId model_id() const { return *ModelId::parse(model); }

  // Returns the bytes of the file that visitors may read. Returns no bytes if they may read none.
  Bytes visible_file() {
    const auto record = server.catalogue().find(model_id()).value();
    if (!record || record->state != ModelState::kPublished) return {};
    return read(record->public_part ? record->public_part->file : record->file);
  }
  Bytes whole_file() {
    const auto record = server.catalogue().find(model_id()).value();
    return record ? read(record->file) : Bytes();
  }

  test::FakeScanner rig;
  test::LocalServer server{public_routes(), std::chrono::seconds(30), one(rig)};
  const std::string tokens[4] = {"", server.bearer(Role::kViewer), server.bearer(Role::kOperator),
                                 server.bearer(Role::kAdmin)};
  std::string scan, job, model;

 private:
  static std::vector<std::unique_ptr<ScannerBackend>> one(test::FakeScanner& rig) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(rig));
    return backends;
  }
  Bytes read(const Sha256& name) {
    const auto object = server.store().open(name).value();
    return object->read(0, object->size()).value();
  }
};

// A state of the scan's model, and what a visitor then gets of the model and of the scan.
struct State {
  const char* name;
  bool is_public_scan;
  void (*enter)(World& world);
  int model_status, scan_status;
};

void patch(World& world, const json& change) {
  const auto answer = world.ask("PATCH", world.model_path(), Role::kOperator, change.dump());
  EXPECT_EQ(answer.status, 200) << answer.body;
}

void cap(World& world) {
  patch(world, {{"public_max_level", 0}});
}

void replace_file(World& world) {
  const auto file = test::store_model(test::on_lattice(test::sheet(24, 24)), {}).file;
  auto& server = world.server;
  ASSERT_TRUE(replace(server.store(), server.catalogue(), file, {}, {.id = world.model_id()}));
  server.services().models.refresh();
}

void withdraw(World& world) {
  EXPECT_EQ(world.ask("POST", world.model_path() + "/unpublish", Role::kOperator).status, 200);
}

void reprocess(World& world, const json& order) {
  const HttpAnswer answer =
      world.ask("POST", world.scan_path() + "/reprocess", Role::kOperator, order.dump());
  EXPECT_EQ(answer.status, 202) << answer.body;
  world.server.scans().jobs().executor("").run([] {});  // returns once the job has ended
}

constexpr State kStates[] = {
    {"published", true, [](World&) {}, 200, 200},
    {"in cm", true,
     [](World& world) {
       patch(world, {{"unit", "cm"}});
     },
     200, 200},
    {"capped at its finest level", true,
     [](World& world) {
       patch(world, {{"public_max_level", 255}});
     },
     200, 200},
    {"capped", true, cap, 200, 401},
    {"replaced", true, replace_file, 200, 401},
    {"capped, replaced", true,
     [](World& world) {
       cap(world);
       replace_file(world);
     },
     200, 401},
    {"withdrawn", true, withdraw, 404, 401},
    {"capped, its scan reprocessed", true,
     [](World& world) {
       cap(world);
       reprocess(world, {{"bits", 14}});
     },
     200, 401},
    {"withdrawn, its scan reprocessed", true,
     [](World& world) {
       withdraw(world);
       reprocess(world, {{"bits", 14}});
     },
     404, 401},
    {"a draft", false, [](World&) {}, 404, 401},
    {"removed", true,
     [](World& world) {
       EXPECT_EQ(world.ask("DELETE", world.model_path(), Role::kOperator).status, 204);
     },
     404, 401},
};

// The access matrix: for each route and column, the lowest status of all responses.
class Matrix {
 public:
  void record(const std::string& route, const std::string& column, int status) {
    if (std::ranges::find(columns_, column) == columns_.end()) columns_.push_back(column);
    int& best = rows_[route][column];
    if (best == 0 || status < best) best = status;
  }
  void print() const {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      fmt::print("[{}] {}\n", i + 1, columns_[i]);
    fmt::print("{:66}", "");
    for (std::size_t i = 0; i < columns_.size(); ++i)
      fmt::print("{:>5}", fmt::format("[{}]", i + 1));
    for (const auto& [route, cells] : rows_) {
      fmt::print("\n{:66}", route);
      for (const std::string& column : columns_)
        fmt::print("{:>5}", cells.contains(column) ? fmt::format("{}", cells.at(column)) : "");
    }
    fmt::print("\n");
  }

 private:
  std::vector<std::string> columns_;
  std::map<std::string, std::map<std::string, int>> rows_;
};

constexpr const char* kMethods[] = {"GET", "POST", "PATCH", "DELETE"};
constexpr const char* kRoles[] = {"visitor", "viewer", "operator", "admin"};

class Walk {
 public:
  Walk(const State& state, Matrix& matrix)
      : state_(state), matrix_(matrix), world_(state.is_public_scan) {
    hide_everything();
    const Bytes before = world_.whole_file();
    state.enter(world_);
    for (const Bytes& file : {before, world_.whole_file()}) {
      secrets_.hide(text_of(file));
      name_chunks(file);
    }
    reveal_what_is_public();
  }

  void run() {
    for (const ApiRoute& route : public_routes()) {
      if (route.method == Method::kOptions) continue;
      for (const Role role : {Role::kNone, Role::kViewer, Role::kOperator, Role::kAdmin})
        walk(route, role);
    }
    EXPECT_FALSE(secrets_.are_in(world_.streamed())) << "the stream";
    const auto status = [&](const std::string& path) {
      return world_.ask("GET", path, Role::kNone).status;
    };
    EXPECT_EQ(status(world_.model_path()), state_.model_status);
    EXPECT_EQ(status(world_.scan_path() + "/points"), state_.scan_status);
    const bool hides_all_from_all = std::string_view(state_.name) == "removed";
    EXPECT_TRUE(came_out_to_admin_ || state_.scan_status == 200 || hides_all_from_all)
        << "the secrets are in no response, so this test proves nothing";
  }

 private:
  // Adds the points, the profile, the pictures and the exports of the scan's model to the secrets.
  void hide_everything() {
    auto paths = exports_of(world_.model);
    paths.insert(paths.end(), {world_.scan_path() + "/points", world_.scan_path() + "/profile",
                               "/api/v1/scanners/rig/preview"});
    for (const std::string& path : paths) {
      const HttpAnswer answer = world_.ask("GET", path, Role::kAdmin);
      EXPECT_EQ(answer.status, 200) << path;
      secrets_.hide(telling_part(path, answer.body));
    }
  }

  // Removes from the secrets all content that visitors may get: exports of the public file, and the
  // points and the profile if the scan is visible.
  void reveal_what_is_public() {
    // Exports state their source, and other responses contain addresses of the same server.
    for (const char* before : {": ", "\":\"", "\": \""})
      secrets_.reveal(before + std::string("http://localhost/models/"));
    if (state_.scan_status == 200) {
      for (const char* part : {"/points", "/profile"})
        secrets_.reveal(world_.ask("GET", world_.scan_path() + part, Role::kAdmin).body);
    }
    const Bytes file = world_.visible_file();
    if (file.empty()) return;
    secrets_.reveal(text_of(file));
    test::LocalServer other(public_routes());
    ASSERT_TRUE(
        publish(other.store(), other.catalogue(), file, {.title = "A"}, {.id = world_.model_id()}));
    for (const std::string& path : exports_of(world_.model))
      secrets_.reveal(telling_part(path, test::http_get(other.port(), path).body));
  }

  void name_chunks(const Bytes& file) {
    if (file.empty()) return;
    const Manifest manifest = parse_header(file).value();
    names_.push_back(to_hex(manifest.base_sha256));
    for (const ChunkInfo& chunk : manifest.chunks)
      names_.push_back(to_hex(chunk.sha256));
  }

  Values values(bool are_real) const {
    std::vector<std::string> ids = {ModelId::generate().to_string()};
    if (are_real) ids.insert(ids.end(), {world_.model, world_.scan, world_.job});
    return {{"id", ids},
            {"sha256", names_},
            {"format", {"glb", "ply", "obj", "stl", "drc", "wrl", "3mf", "usdz", "obj.zip"}},
            {"name", {"rig"}},
            {"number", {"1"}},
            {"rest", {"docs.js", "model.html"}}};
  }

  // Requests that change something name the real model, scan and job only if `role` must be
  // refused.
  void walk(const ApiRoute& route, Role role) {
    const bool may = role >= route.role, reads = route.method == Method::kGet;
    const char* method = kMethods[static_cast<std::size_t>(route.method)];
    for (const std::string& path : expanded(std::string(route.path), values(reads || !may))) {
      for (const std::string& query : queries_of(route.path, world_.model)) {
        const HttpAnswer answer = world_.ask(method, path + query, role);
        check(
            answer,
            fmt::format("{} {} {}{}", kRoles[static_cast<std::size_t>(role)], method, path, query),
            role, may);
        matrix_.record(fmt::format("{} {}", method, route.path), column(role), answer.status);
      }
    }
  }

  void check(const HttpAnswer& answer, const std::string& request, Role role, bool may) {
    const bool is_of_interest =
        role == Role::kNone || (role == Role::kAdmin && !came_out_to_admin_);
    const bool has_secret = is_of_interest && secrets_.are_in(answer.body);
    came_out_to_admin_ = came_out_to_admin_ || (has_secret && role == Role::kAdmin);
    EXPECT_FALSE(has_secret && role == Role::kNone) << request << ": " << state_.name;
    const int refused = role == Role::kNone ? 401 : 403;
    EXPECT_TRUE(may || answer.status == refused) << request << ": " << answer.status;
    EXPECT_FALSE(may && role != Role::kNone && answer.status == 403) << request;
    EXPECT_LT(answer.status, 500) << request << ": " << answer.body;
  }

  // Returns the column of a role. Visitors have one column for each state of the model, because
  // only they see less in some states.
  std::string column(Role role) const {
    const char* name = kRoles[static_cast<std::size_t>(role)];
    return role == Role::kNone ? fmt::format("{}; the model is {}", name, state_.name) : name;
  }

  const State& state_;
  Matrix& matrix_;
  World world_;
  Secrets secrets_;
  std::vector<std::string> names_;  // SHA-256 of all chunks that the model has or had
  bool came_out_to_admin_ = false;
};

TEST(Visibility, ARebuiltModelIsAsPublicAsTheOneBeforeUnlessTheOrderSaysWhether) {
  World world(true);
  const auto status = [&](const std::string& model) {
    return world.ask("GET", "/api/v1/models/" + model, Role::kNone).status;
  };
  const auto model = [&] {
    return json::parse(world.ask("GET", world.scan_path(), Role::kAdmin).body).at("model");
  };
  const std::string first = world.model;
  reprocess(world, {{"bits", 14}});
  world.model = model();
  EXPECT_NE(world.model, first);
  EXPECT_EQ(status(first), 404);
  EXPECT_EQ(status(world.model), 200);

  cap(world);
  const json publish = {{"publish", true}};
  EXPECT_EQ(
      world.ask("POST", world.scan_path() + "/reprocess", Role::kOperator, publish.dump()).status,
      409);
  reprocess(world, {{"bits", 13}});
  EXPECT_EQ(model(), world.model) << "a draft does not replace what visitors see";

  patch(world, {{"public_max_level", nullptr}});
  withdraw(world);
  reprocess(world, {{"bits", 12}});
  EXPECT_EQ(status(model()), 404);
  reprocess(world, publish);
  EXPECT_EQ(status(model()), 200);
}

TEST(Visibility, NothingThatAModelHidesComesOutOfAnyRoute) {
  Matrix matrix;
  for (const State& state : kStates) {
    SCOPED_TRACE(state.name);
    Walk(state, matrix).run();
  }
  matrix.print();
}

}  // namespace
}  // namespace vitrine::server
