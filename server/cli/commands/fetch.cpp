// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/stream_client.h"

#include <fmt/format.h>

#include <filesystem>

#include "codec/build/open_model.h"
#include "codec/export/write_mesh.h"
#include "codec/files/atomic_file.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/levels.h"
#include "server/cli/support/wants.h"
#include "server/stream/message.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Order {
  FetchOptions options;
  std::optional<MeshFormat> format;  // format of the output; nullopt for .pmesh
};

// Reads a detail target from a file with the object `view` of PROTOCOL.md.
tl::expected<DetailTarget, Fault> read_view_file(const std::string& path) {
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const std::string text(file->bytes().begin(), file->bytes().end());
  const bool is_json = text.size() <= kMaxMessage && nlohmann::json::accept(text);
  const auto message =
      parse_message(is_json ? fmt::format(R"({{"type":"want","view":{}}})", text) : std::string());
  if (!message)
    return failed(fmt::format(
        "{} is not a view; give an object with camera (16 numbers), fov, width, height, pixels "
        "and, optionally, bytes, as PROTOCOL.md describes",
        path));
  return std::get<WantMessage>(*message).target;
}

tl::expected<std::optional<DetailTarget>, Fault> read_detail_target(const Arguments& arguments) {
  const auto want = read_want(arguments);
  if (!want) return tl::unexpected(want.error());
  const auto seconds = arguments.number_between("--seconds", 0.01, kMaxSeconds);
  if (!seconds) return tl::unexpected(seconds.error());
  if (want->has_value() + seconds->has_value() + arguments.has("--view") > 1)
    return misused(
        "--seconds, --view and the group --level, --triangles, --bytes and --error exclude each "
        "other; give one");
  if (arguments.has("--view")) return read_view_file(arguments.text("--view"));
  if (*seconds) return DetailTarget(WantSeconds{**seconds});
  return *want ? std::optional<DetailTarget>(**want) : std::nullopt;
}

tl::expected<Order, Fault> read_order(const Arguments& arguments) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  Order order;
  order.options.out = arguments.text("-o");
  const std::string extension = order.options.out.extension().string();
  order.format = format_of_extension(extension);
  if (!order.format && extension != ".pmesh")
    return misused(fmt::format("cannot tell the output format from its name; use one of {}, .pmesh",
                               std::string_view(kExportSuffixes)));
  const auto target = read_detail_target(arguments);
  if (!target) return tl::unexpected(target.error());
  if (*target && !order.format)
    return misused(
        "a .pmesh file contains the whole model; choose another format, or leave out the detail "
        "flag");
  order.options.target = *target;
  auto url = parse_model_url(arguments.operand(0));
  if (!url) return misused(url.error().message);
  order.options.url = std::move(*url);
  order.options.token = arguments.text("--token");
  return order;
}

// Returns the number of bytes of the file up to the coarsest level that meets `target`, or the
// number that `target` asks for if it is in bytes.
double bytes_for(const Manifest& m, const std::optional<DetailTarget>& target) {
  const auto* want = target ? std::get_if<Want>(&*target) : nullptr;
  if (want == nullptr) return static_cast<double>(m.file_bytes);
  if (const auto* w = std::get_if<WantBytes>(want)) return static_cast<double>(w->bytes);
  std::uint32_t level = 0;
  const auto suffices = [&](const LevelInfo& info) {
    if (const auto* w = std::get_if<WantTriangles>(want)) return info.faces >= w->triangles;
    if (const auto* w = std::get_if<WantError>(want)) return info.max_error <= w->error;
    const auto* w = std::get_if<WantLevel>(want);
    return w != nullptr && level >= w->level;
  };
  while (level + 1 < m.levels.size() && !suffices(m.levels[level]))
    ++level;
  return static_cast<double>(m.cumulative_bytes(level));
}

std::uint64_t triangles_of(const PartialModel& model) {
  Planner planner(*model.manifest());
  for (std::size_t i = 0; i < model.manifest()->chunks.size(); ++i) {
    if (model.holds(i)) planner.have(i);
  }
  return planner.faces_held();
}

// Shows the progress of a fetch: triangles, bytes and error.
class FetchBar {
 public:
  explicit FetchBar(const std::optional<DetailTarget>& target) : target_(target) {}

  void show(const PartialModel& model) {
    // Counts the triangles only once per interval, since counting examines every chunk.
    constexpr std::chrono::milliseconds kInterval{100};
    const auto now = Clock::now();
    if (now - shown_ < kInterval) return;
    shown_ = now;
    const Manifest& m = *model.manifest();
    bar_.report()(fmt::format("{} triangles, {:.2f} MB, error {}", triangles_of(model),
                              static_cast<double>(model.bytes()) / 1e6,
                              bound_text(m.levels[model.level()].max_error)),
                  fraction(model));
  }

 private:
  double fraction(const PartialModel& model) const {
    const auto* timed = target_ ? std::get_if<WantSeconds>(&*target_) : nullptr;
    const std::chrono::duration<double> since = shown_ - start_;
    if (timed != nullptr) return std::min(1.0, since.count() / timed->seconds);
    const double goal = bytes_for(*model.manifest(), target_);
    return std::min(1.0, static_cast<double>(model.bytes()) / goal);
  }

  const std::optional<DetailTarget>& target_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
  ProgressBar bar_;
};

tl::expected<Fetched, Fault> receive(FetchOptions options) {
  FetchBar bar(options.target);
  options.on_progress = [&](const PartialModel& model) { bar.show(model); };
  auto fetched = fetch(options);
  if (!fetched)
    return failed(fmt::format("{}: {}", options.url.authority(), fetched.error().message));
  return std::move(*fetched);
}

// Decodes the complete chunks in file order, except those that depend on a missing chunk. Returns
// the mesh file.
Expected<Product> decode_held(const PartialModel& model, std::span<const std::uint8_t> pmesh,
                              const Order& order) {
  auto refiner = open_model(pmesh);
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const ChunkReader chunks = chunks_of(manifest, pmesh);
  for (std::size_t i = 0; i < manifest.chunks.size(); ++i) {
    if (!model.holds(i) || !refiner->is_ready(i)) continue;
    const auto bytes = chunks(i);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto applied = refiner->apply(i, *bytes); !applied) return tl::unexpected(applied.error());
  }
  const auto* want = order.options.target ? std::get_if<Want>(&*order.options.target) : nullptr;
  const auto* triangles = want != nullptr ? std::get_if<WantTriangles>(want) : nullptr;
  if (triangles != nullptr && triangles->triangles < refiner->face_count())
    refiner->undo_to_faces(static_cast<std::uint32_t>(triangles->triangles));
  const TriangleMesh mesh = refiner->display_mesh();
  auto file = write_mesh(mesh, *order.format, manifest.unit);
  if (!file) return tl::unexpected(file.error());
  nlohmann::json report = {{"faces", mesh.faces.size()}, {"vertices", mesh.positions.size()}};
  if (auto note = note_on_precision(mesh, *order.format); !note.empty()) report["note"] = note;
  return Product{std::move(report), std::move(*file)};
}

// Writes the output file and returns its numbers of faces and vertices.
tl::expected<nlohmann::json, Fault> write_out(const PartialModel& model, const Order& order) {
  const std::string out = order.options.out.string();
  const auto part = InputFile::open(model.path().string());
  if (!part) return failed(part.error());
  if (!order.format) {
    if (auto written = write_file_atomically(out, part->bytes()); !written)
      return failed(written.error());
    const LevelInfo& finest = model.manifest()->levels.back();
    return nlohmann::json{{"faces", finest.faces}, {"vertices", finest.vertices}};
  }
  const auto product =
      isolate(out, [&](const ProgressReport&) { return decode_held(model, part->bytes(), order); });
  if (!product) return tl::unexpected(product.error());
  if (auto written = write_file_atomically(out, product->file); !written)
    return failed(written.error());
  return product->report;
}

nlohmann::json promise_json(const PromiseMessage& promise) {
  return {{"level", promise.level},         {"bytes", promise.bytes},
          {"triangles", promise.triangles}, {"error", promise.error},
          {"seconds", promise.seconds},     {"bytes_per_second", promise.bytes_per_second},
          {"measured", promise.measured}};
}

CommandOutcome fetch_model(const Arguments& arguments) {
  const auto order = read_order(arguments);
  if (!order) return tl::unexpected(order.error());
  const std::string out = order->options.out.string();
  if (const auto writable = check_writable(out); !writable) return failed(writable.error());
  const auto fetched = receive(order->options);
  if (!fetched) return tl::unexpected(fetched.error());
  const PartialModel& model = fetched->model;
  const auto* want = order->options.target ? std::get_if<Want>(&*order->options.target) : nullptr;
  if (want != nullptr) {
    if (auto met = check_want(*model.manifest(), *want); !met) return failed(met.error());
  }
  auto report = write_out(model, *order);
  if (!report) return tl::unexpected(report.error());
  std::error_code kept;  // ignored: a file that cannot be removed is used by the next run
  fs::remove(model.path(), kept);
  (*report)["bytes"] = model.bytes();
  (*report)["received_bytes"] = fetched->received;
  (*report)["level"] = model.level();
  (*report)["error"] = model.manifest()->levels[model.level()].max_error;
  (*report)["seconds"] = fetched->seconds;
  if (fetched->promise) (*report)["promise"] = promise_json(*fetched->promise);
  if (arguments.has("--json")) return print_json(*report);
  return print(fmt::format("{}: {} faces, {} vertices from {} bytes in {:.2f} s", out,
                           (*report)["faces"].get<std::uint64_t>(),
                           (*report)["vertices"].get<std::uint64_t>(), model.bytes(),
                           fetched->seconds));
}

constexpr std::string_view kFetchOperands[] = {"URL"};
constexpr FixedText kFetchOutput = concatenate("OUT.{", kExportChoice, ",pmesh}");
constexpr Flag kFetchFlags[] = {
    {"-o", kFetchOutput, "file in the model's unit; .glb, .wrl: m (required)"},
    {"--level", "L", "level of detail; 0 is the coarsest"},
    {"--triangles", "N", "finest mesh with at most N triangles"},
    {"--bytes", "B", "finest mesh in the first B bytes of the file"},
    {"--error", "E", "coarsest level within E of the original, in the model's unit"},
    {"--seconds", "S", "finest mesh that arrives within S seconds"},
    {"--view", "FILE.json",
     "detail for a camera: an object with camera (16 numbers), fov, width, height, pixels, "
     "optionally bytes; see server/stream/PROTOCOL.md"},
    {"--token", "T", "token of role viewer or higher, for unpublished models"},
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kFetch = {.name = "fetch",
                        .summary = "Fetches a model from a server, at full or reduced detail.",
                        .details =
                            "URL is the address of a model's page, such as "
                            "https://museum.example/models/ID. The name of OUT chooses the format. "
                            "--level, --triangles, --bytes, --error, --seconds and --view exclude "
                            "each other; without any, the whole model is fetched. An interrupted "
                            "fetch continues when the command is run again.",
                        .operands = kFetchOperands,
                        .flags = kFetchFlags,
                        .run = fetch_model};

}  // namespace vitrine::server::cli
