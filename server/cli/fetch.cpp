// SPDX-License-Identifier: Apache-2.0
#include "server/fetch/stream_client.h"

#include <fmt/format.h>

#include <filesystem>

#include "codec/export/write_mesh.h"
#include "codec/files/atomic_file.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/input.h"
#include "server/cli/isolation.h"
#include "server/cli/levels.h"
#include "server/cli/wants.h"
#include "server/jobs/open_model.h"
#include "server/stream/message.h"

namespace vitrine::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Order {
  FetchOptions options;
  std::optional<MeshFormat> format;  // nothing: the .pmesh itself
};

// A file with the object that PROTOCOL.md calls `view`.
tl::expected<Wish, Fault> read_view_file(const std::string& path) {
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const std::string text(file->bytes().begin(), file->bytes().end());
  const bool is_json = text.size() <= kMaxMessage && nlohmann::json::accept(text);
  const auto message =
      parse_message(is_json ? fmt::format(R"({{"type":"want","view":{}}})", text) : std::string());
  if (!message)
    return failed(fmt::format(
        "{} is no view; give an object of camera (16 numbers), fov, width, height, pixels and, if "
        "wanted, bytes, as PROTOCOL.md has it",
        path));
  return std::get<WantMessage>(*message).wish;
}

tl::expected<std::optional<Wish>, Fault> read_wish(const Arguments& arguments) {
  const auto want = read_want(arguments);
  if (!want) return tl::unexpected(want.error());
  const auto seconds = arguments.number_between("--seconds", 0.01, kMaxSeconds);
  if (!seconds) return tl::unexpected(seconds.error());
  if (want->has_value() + seconds->has_value() + arguments.has("--view") > 1)
    return misused(
        "--seconds and --view go with none of --level, --triangles, --bytes and --error, nor with "
        "each other; give one");
  if (arguments.has("--view")) return read_view_file(arguments.text("--view"));
  if (*seconds) return Wish(WantSeconds{**seconds});
  return *want ? std::optional<Wish>(**want) : std::nullopt;
}

tl::expected<Order, Fault> read_order(const Arguments& arguments) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  Order order;
  order.options.out = arguments.text("-o");
  const std::string extension = order.options.out.extension().string();
  order.format = format_of_extension(extension);
  if (!order.format && extension != ".pmesh")
    return misused(
        "the output's name tells no format; end it in .ply, .glb, .obj, .stl, .drc, .wrl or "
        ".pmesh");
  const auto wish = read_wish(arguments);
  if (!wish) return tl::unexpected(wish.error());
  if (*wish && !order.format)
    return misused("a .pmesh is whole; name another format, or ask for no part of it");
  order.options.wish = *wish;
  auto url = parse_model_url(arguments.operand(0));
  if (!url) return misused(url.error().message);
  order.options.url = std::move(*url);
  order.options.token = arguments.text("--token");
  return order;
}

// Bytes of the first level that is as fine as wanted.
double bytes_for(const Manifest& m, const std::optional<Wish>& wish) {
  const auto* want = wish ? std::get_if<Want>(&*wish) : nullptr;
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

// Shows what is there: triangles, bytes, error.
class FetchBar {
 public:
  explicit FetchBar(const std::optional<Wish>& wish) : wish_(wish) {}

  void show(const PartialModel& model) {
    constexpr std::chrono::milliseconds kInterval{100};  // counting looks at every chunk
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
    const auto* timed = wish_ ? std::get_if<WantSeconds>(&*wish_) : nullptr;
    const std::chrono::duration<double> since = shown_ - start_;
    if (timed != nullptr) return std::min(1.0, since.count() / timed->seconds);
    const double goal = bytes_for(*model.manifest(), wish_);
    return std::min(1.0, static_cast<double>(model.bytes()) / goal);
  }

  const std::optional<Wish>& wish_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point shown_{};
  ProgressBar bar_;
};

tl::expected<Fetched, Fault> receive(FetchOptions options) {
  FetchBar bar(options.wish);
  options.on_progress = [&](const PartialModel& model) { bar.show(model); };
  auto fetched = fetch(options);
  if (!fetched)
    return failed(fmt::format("{}: {}", options.url.authority(), fetched.error().message));
  return std::move(*fetched);
}

// All that is held, in file order, which can be applied.
Expected<Product> decode_held(const PartialModel& model, std::span<const std::uint8_t> pmesh,
                              const Order& order) {
  auto refiner = open_model(pmesh);
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const ChunkReader chunks = chunks_of(manifest, pmesh);
  for (std::size_t i = 0; i < manifest.chunks.size(); ++i) {
    if (!model.holds(i) || !refiner->ready(i)) continue;
    const auto bytes = chunks(i);
    if (!bytes) return tl::unexpected(bytes.error());
    if (auto applied = refiner->apply(i, *bytes); !applied) return tl::unexpected(applied.error());
  }
  const auto* want = order.options.wish ? std::get_if<Want>(&*order.options.wish) : nullptr;
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

// Writes OUT; what it counts.
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

Outcome fetch_model(const Arguments& arguments) {
  const auto order = read_order(arguments);
  if (!order) return tl::unexpected(order.error());
  const std::string out = order->options.out.string();
  if (const auto writable = check_writable(out); !writable) return failed(writable.error());
  const auto fetched = receive(order->options);
  if (!fetched) return tl::unexpected(fetched.error());
  const PartialModel& model = fetched->model;
  const auto* want = order->options.wish ? std::get_if<Want>(&*order->options.wish) : nullptr;
  if (want != nullptr) {
    if (auto met = check_want(*model.manifest(), *want); !met) return failed(met.error());
  }
  auto report = write_out(model, *order);
  if (!report) return tl::unexpected(report.error());
  std::error_code kept;  // then the next run finds it
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
constexpr Flag kFetchFlags[] = {
    {"-o", "OUT.{ply,glb,obj,stl,drc,wrl,pmesh}", "the file to write; .glb and .wrl are in metres"},
    {"--level", "L", "this level; 0 is the base (default: the finest)"},
    {"--triangles", "N", "the finest state of at most N triangles"},
    {"--bytes", "B", "the finest state that at most B bytes of the file hold"},
    {"--error", "E", "the coarsest level off by at most E, in the model's unit"},
    {"--seconds", "S", "as much as the connection brings in S seconds"},
    {"--view", "FILE.json", "what a camera sees: camera, fov, width, height, pixels, bytes"},
    {"--token", "T", "an access token, for drafts"},
    {"--json", "", "print one JSON object"}};

}  // namespace

const Command kFetch = {"fetch", "Fetches a model, or a part of it, from a server.", kFetchOperands,
                        kFetchFlags, fetch_model};

}  // namespace vitrine::cli
