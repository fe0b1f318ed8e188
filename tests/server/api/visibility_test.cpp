// SPDX-License-Identifier: Apache-2.0
// Sends every request with every role, for each state of a scan's model. No response to a visitor
// may contain data that the model's state hides. Prints the access matrix.
#include "server/api/visibility.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/api/routes.h"
#include "server/store/change.h"
#include "support/access_matrix.h"
#include "support/damage_object.h"
#include "support/fake_backend.h"
#include "support/held_executor.h"
#include "support/hierarchies.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/stored_model.h"

namespace vitrine::server {
namespace {

using nlohmann::json;
using test::AccessMatrix;
using test::HttpAnswer;
using test::Secrets;
using Bytes = std::vector<std::uint8_t>;

std::string text_of(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

// Texts to insert for each parameter of a route.
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

// Returns the queries with which a route could reveal more than it does without a query.
std::vector<std::string> queries_of(std::string_view path, const std::string& model) {
  if (path.ends_with("/export.{format}")) return {"", "?level=highest", "?lod=msft"};
  if (path.ends_with("/manifest")) return {"", "?level=highest"};
  if (path.ends_with("/poster.png")) return {"?width=240"};
  if (path == "/api/v1/models" || path == "/api/v1/facets") return {"", "?drafts=true"};
  if (path == "/api/v1/oai") {
    return {"?verb=ListRecords&metadataPrefix=oai_dc", "?verb=ListRecords&metadataPrefix=lido",
            "?verb=GetRecord&metadataPrefix=edm&identifier=oai:localhost:" + model};
  }
  if (path == "/api/v1/oembed") return {"?url=http://localhost/models/" + model};
  return {""};
}

std::vector<std::string> exports_of(const std::string& model) {
  const std::string path = "/api/v1/models/" + model;
  std::vector<std::string> paths = {path + "/poster.png?width=240"};
  for (const char* format : {"glb", "ply", "obj", "stl", "drc", "wrl", "3mf", "usdz", "obj.zip"})
    paths.push_back(path + "/export." + format);
  paths.push_back(path + "/export.glb?lod=msft");
  return paths;
}

// Returns the part of an export that reveals the model's shape or look. For USDZ, this is only the
// list of positions, because the lists of indices look like lists in a manifest.
std::string_view telling_part(std::string_view path, std::string_view body) {
  if (!path.ends_with(".usdz")) return body;
  const std::size_t begin = body.find("point3f[] points"), end = body.find(']', begin + 16);
  EXPECT_NE(end, std::string_view::npos) << path;
  return begin == std::string_view::npos ? "" : body.substr(begin + 16, end - begin - 16);
}

// How far a scan has come.
enum class Phase { kModel, kScanning };  // has become a model; still waits at a step

// A server with a scan that is ordered as public or as a draft.
class World {
 public:
  explicit World(bool is_public, Phase phase = Phase::kModel) {
    if (phase == Phase::kScanning) step.emplace(rig, 6);
    EXPECT_TRUE(server.scans().start());
    const json started =
        json::parse(ask("POST", "/api/v1/scans", Role::kOperator,
                        json{{"scanner", "rig"},
                             {"steps", 12},
                             {"metadata", {{"title", "A"}, {"collection", "Hidden cabinet"}}},
                             {"publish", is_public}}
                            .dump())
                        .body);
    scan = started.at("id");
    job = started.at("job");
    if (step) {
      step->await();
      model = ModelId::generate().to_string();  // a model that does not exist
      return;
    }
    server.scans().jobs().executor("rig").run([] {});  // returns once the scan has ended
    model = json::parse(ask("GET", scan_path(), Role::kAdmin).body).at("model");
  }
  ~World() {
    if (step) step->open();
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Sends a request. A body is JSON if `fields` does not name its type.
  HttpAnswer ask(const std::string& method, const std::string& path, Role role,
                 const std::string& body = "", std::string fields = "") {
    if (fields.empty() && !body.empty()) fields = "Content-Type: application/json\r\n";
    test::HttpClient client(server.port());
    client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\n{}{}Content-Length: {}\r\n\r\n{}",
                            method, path, tokens[static_cast<std::size_t>(role)], fields,
                            body.size(), body));
    HttpAnswer answer = client.receive();
    if (answer.field("content-type") != "text/event-stream") return answer;
    // The stream of a waiting job has one event and stays open. Any other stream is read until it
    // ends.
    const bool job_waits = held || step;
    try {
      while (!job_waits || !answer.body.ends_with("\n\n"))
        answer.body += client.read_exactly(1);
    } catch (const std::runtime_error&) {  // the connection has ended as expected
    }
    return answer;
  }

  // Returns a visitor's response to a HEAD request, and checks that nothing follows it.
  HttpAnswer head(const std::string& path) {
    test::HttpClient client(server.port());
    const HttpAnswer answer = client.get(path, "Connection: close\r\n", "HEAD");
    EXPECT_TRUE(client.is_closed()) << "a body follows the response to HEAD " << path;
    return answer;
  }

  // Returns the bytes that a visitor receives over the stream, including the model's head.
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
    } catch (const std::runtime_error&) {  // the visitor may not see the model
    }
    return bytes;
  }

  std::string scan_path() const { return "/api/v1/scans/" + scan; }
  std::string model_path() const { return "/api/v1/models/" + model; }
  ModelId model_id() const { return *ModelId::parse(model); }

  // Returns the bytes of the file that visitors may read, or no bytes if visitors may read no file.
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
  std::unique_ptr<test::HeldExecutor> held;  // while it is not null, jobs that build models wait
  std::optional<test::HeldAtStep> step;      // has a value if the scan waits at a step

 private:
  static std::vector<std::unique_ptr<ScannerBackend>> one(test::FakeScanner& rig) {
    std::vector<std::unique_ptr<ScannerBackend>> backends;
    backends.push_back(std::make_unique<test::FakeBackend>(rig));
    return backends;
  }
  Bytes read(const Sha256& name) {
    const auto object = server.store().open(name);
    return object ? (*object)->read(0, (*object)->size()).value() : Bytes();
  }
};

constexpr int kDamaged = 500;  // the status of each request that needs a damaged file

// A state of the scan's model, and the statuses with which a visitor's requests for the model and
// the scan are then answered.
struct State {
  const char* name;
  bool is_public_scan = true;
  void (*enter)(World& world) = [](World&) {};
  struct {
    int model, scan;
  } statuses;
  Phase phase = Phase::kModel;
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

void reprocess_later(World& world) {
  world.held = std::make_unique<test::HeldExecutor>(world.server.scans().jobs().executor(""));
  const HttpAnswer answer =
      world.ask("POST", world.scan_path() + "/reprocess", Role::kOperator, R"({"bits":14})");
  EXPECT_EQ(answer.status, 202) << answer.body;
  world.job = json::parse(answer.body).at("job");
}

void damage(World& world) {
  const auto record = world.server.catalogue().find(world.model_id()).value();
  test::damage_object(world.server.data(), record->file);
  EXPECT_TRUE(world.server.scrubber().check_all());
}

void cancel_scan(World& world) {
  EXPECT_EQ(world.ask("DELETE", "/api/v1/jobs/" + world.job, Role::kOperator).status, 202);
  world.step->open();
  world.server.scans().jobs().executor("rig").run([] {});  // returns once the scan has ended
  world.step.reset();
}

constexpr State kStates[] = {
    {.name = "not made yet, its scan ordered as public",
     .statuses = {404, 200},
     .phase = Phase::kScanning},
    {.name = "not made yet, its scan ordered as a draft",
     .is_public_scan = false,
     .statuses = {404, 401},
     .phase = Phase::kScanning},
    {.name = "not made, its public scan cancelled",
     .enter = cancel_scan,
     .statuses = {404, 401},
     .phase = Phase::kScanning},
    {.name = "published", .statuses = {200, 200}},
    {.name = "published again",
     .enter =
         [](World& world) {
           withdraw(world);
           EXPECT_EQ(world.ask("POST", world.model_path() + "/publish", Role::kOperator).status,
                     200);
         },
     .statuses = {200, 200}},
    {.name = "published, its scan being reprocessed",
     .enter = reprocess_later,
     .statuses = {200, 200}},
    {.name = "withdrawn, its scan being reprocessed",
     .enter =
         [](World& world) {
           withdraw(world);
           reprocess_later(world);
         },
     .statuses = {404, 401}},
    {.name = "damaged", .enter = damage, .statuses = {kDamaged, 401}},
    {.name = "in cm",
     .enter =
         [](World& world) {
           patch(world, {{"unit", "cm"}});
         },
     .statuses = {200, 200}},
    {.name = "capped at its finest level",
     .enter =
         [](World& world) {
           patch(world, {{"public_max_level", 255}});
         },
     .statuses = {200, 200}},
    {.name = "capped", .enter = cap, .statuses = {200, 401}},
    {.name = "replaced", .enter = replace_file, .statuses = {200, 401}},
    {.name = "capped, replaced",
     .enter =
         [](World& world) {
           cap(world);
           replace_file(world);
         },
     .statuses = {200, 401}},
    {.name = "withdrawn", .enter = withdraw, .statuses = {404, 401}},
    {.name = "capped, its scan reprocessed",
     .enter =
         [](World& world) {
           cap(world);
           reprocess(world, {{"bits", 14}});
         },
     .statuses = {200, 401}},
    {.name = "withdrawn, its scan reprocessed",
     .enter =
         [](World& world) {
           withdraw(world);
           reprocess(world, {{"bits", 14}});
         },
     .statuses = {404, 401}},
    {.name = "a draft", .is_public_scan = false, .statuses = {404, 401}},
    {.name = "removed",
     .enter =
         [](World& world) {
           EXPECT_EQ(world.ask("DELETE", world.model_path(), Role::kOperator).status, 204);
         },
     .statuses = {404, 401}},
};

constexpr const char* kMethods[] = {"GET", "POST", "PATCH", "DELETE", "PUT"};
constexpr const char* kRoles[] = {"visitor", "viewer", "operator", "admin"};

class Walk {
 public:
  Walk(const State& state, AccessMatrix& matrix)
      : state_(state), matrix_(matrix), world_(state.is_public_scan, state.phase) {
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
    EXPECT_EQ(status(world_.model_path()), state_.statuses.model);
    EXPECT_EQ(status(world_.scan_path() + "/points"), state_.statuses.scan);
    const bool hides_all_from_all = std::string_view(state_.name) == "removed";
    EXPECT_TRUE(came_out_to_admin_ || state_.statuses.scan == 200 || hides_all_from_all)
        << "the secrets are in no response, so this test proves nothing";
  }

 private:
  // Adds the scan's points, profile and pictures and the exports of its model to the secrets.
  void hide_everything() {
    auto paths = world_.step ? std::vector<std::string>() : exports_of(world_.model);
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
    for (const char* before : {": ", "\":\"", "\": \"", ">"})
      secrets_.reveal(before + std::string("http://localhost/models/"));
    // A response may repeat the ID that the request names, in quotes or as the end of an element.
    for (const char* after : {"\"", "<"})
      secrets_.reveal(world_.model + after);
    // Exports and the records of other models have these texts of XML in common.
    for (const char* text :
         {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<", "\"http://purl.org/dc/elements/1.1/\"",
          "\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\""})
      secrets_.reveal(text);
    if (state_.statuses.scan == 200) {
      for (const char* part : {"/points", "/profile"})
        secrets_.reveal(world_.ask("GET", world_.scan_path() + part, Role::kAdmin).body);
    }
    const Bytes file = world_.visible_file();
    if (state_.statuses.model == kDamaged) reveal_the_record();
    if (file.empty()) return;
    secrets_.reveal(text_of(file));
    test::LocalServer other(public_routes());
    ASSERT_TRUE(
        publish(other.store(), other.catalogue(), file, {.title = "A"}, {.id = world_.model_id()}));
    for (const std::string& path : exports_of(world_.model))
      secrets_.reveal(telling_part(path, test::http_get(other.port(), path).body));
  }

  // Visitors may see what the catalogue knows of a model, even if its file is damaged: the list of
  // models shows it.
  void reveal_the_record() {
    secrets_.reveal("http://localhost" + world_.model_path() + "/");
    secrets_.reveal("http://localhost/models/" + world_.model + "/");
    secrets_.reveal(world_.ask("GET", "/api/v1/models", Role::kNone).body);
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
            {"collection", {"Hidden%20cabinet"}},
            {"number", {"1"}},
            {"rest", {"docs.js", "model.html"}}};
  }

  // Requests all paths of the route. A request that changes data names the real model, scan and job
  // only if the server must refuse it to `role`, because later requests still need them.
  void walk(const ApiRoute& route, Role role) {
    const bool may = role >= route.role, reads = route.method == Method::kGet;
    const char* method = kMethods[static_cast<std::size_t>(route.method)];
    for (const std::string& path : expanded(std::string(route.path), values(reads || !may))) {
      for (const std::string& query : queries_of(route.path, world_.model)) {
        const HttpAnswer answer = send(route, path, query, role);
        const auto request =
            fmt::format("{} {} {}{}", kRoles[static_cast<std::size_t>(role)], method, path, query);
        check(answer, request, role, may);
        if (reads && role == Role::kNone) read_otherwise(path + query, answer.status);
        const bool fails = state_.statuses.model == kDamaged && may && reads &&
                           needs_file(route.path, path + query);
        EXPECT_EQ(answer.status >= 500 ? answer.status : 0, fails ? kDamaged : 0)
            << request << ": " << answer.body;
        matrix_.record(fmt::format("{} {}", method, route.path), column(role), answer.status);
      }
    }
  }

  // Sends the query in the target, or in the body if the route reads a form.
  HttpAnswer send(const ApiRoute& route, const std::string& path, const std::string& query,
                  Role role) {
    const char* method = kMethods[static_cast<std::size_t>(route.method)];
    if (route.method != Method::kPost || route.body != BodyKind::kForm)
      return world_.ask(method, path + query, role);
    const HttpAnswer answer = world_.ask(method, path, role, query.substr(1),
                                         "Content-Type: application/x-www-form-urlencoded\r\n");
    EXPECT_EQ(answer.body.find("badVerb"), answer.body.npos) << "the form is not read";
    return answer;
  }

  // Sends a visitor's HEAD request and a visitor's range request. GET responds to `target` with
  // `status`, so these requests must get a corresponding status.
  void read_otherwise(const std::string& target, int status) {
    EXPECT_EQ(world_.head(target).status, status) << "HEAD " << target;
    const HttpAnswer part = world_.ask("GET", target, Role::kNone, "", "Range: bytes=1-\r\n");
    check(part, "a range of " + target, Role::kNone, true);
    const bool is_empty = part.status == 416;  // the pages of this server are empty
    EXPECT_EQ(part.status == 206 || is_empty ? 200 : part.status, status)
        << "a range of " << target;
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
  }

  // Whether a GET request of an existing route needs the file of the scan's model.
  bool needs_file(std::string_view route, std::string_view target) const {
    if (route == "/api/v1/chunks/{sha256}") return true;
    const bool is_of_model = route.find("/models/{id}") != route.npos ||
                             route.starts_with("/api/v1/iiif/") || route.ends_with("/oembed");
    return is_of_model && !route.ends_with("/stream") && target.find(world_.model) != target.npos;
  }

  // Returns the name of the role's column. Visitors have one column for each state of the model,
  // because only visitors see less in some states.
  std::string column(Role role) const {
    const char* name = kRoles[static_cast<std::size_t>(role)];
    return role == Role::kNone ? fmt::format("{}; the model is {}", name, state_.name) : name;
  }

  const State& state_;
  AccessMatrix& matrix_;
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
  AccessMatrix matrix;
  for (const State& state : kStates) {
    SCOPED_TRACE(state.name);
    Walk(state, matrix).run();
  }
  matrix.print();
}

}  // namespace
}  // namespace vitrine::server
