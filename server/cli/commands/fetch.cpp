// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/stream_client.h"

#include <fmt/format.h>

#include <filesystem>
#include <numeric>

#include "codec/build/exported_texture.h"
#include "codec/build/open_model.h"
#include "codec/export/write_mesh.h"
#include "codec/files/atomic_file.h"
#include "server/cli/client/fetch_pictures.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/access_token.h"
#include "server/cli/support/console.h"
#include "server/cli/support/exported_mesh.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/levels.h"
#include "server/cli/support/output.h"
#include "server/cli/support/wants.h"
#include "server/stream/message.h"

namespace vitrine::server::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Order {
  FetchOptions options;
  std::optional<ExportKind> kind;  // kind of the output; nullopt for .pmesh
  // Largest width of the pictures in the output, in pixels. nullopt: chosen by the detail.
  std::optional<std::uint32_t> texture_side = {};
  ExportChoices choices = {};
};

// Reads a detail target from a file that contains the JSON object `view` of PROTOCOL.md.
tl::expected<DetailTarget, Fault> read_view_file(const std::string& path) {
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  const std::string text(file->bytes().begin(), file->bytes().end());
  const bool is_json = text.size() <= kMaxMessage && nlohmann::json::accept(text);
  const auto message =
      parse_message(is_json ? fmt::format(R"({{"type":"want","view":{}}})", text) : std::string());
  if (!message)
    return failed(fmt::format(
        "{} is not a view; give a JSON object with camera (16 numbers), fov, width, height, pixels "
        "and, optionally, bytes; 'vitrine help fetch' describes each",
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
  const auto name = name_of_output(arguments, "pmesh");
  if (!name) return tl::unexpected(name.error());
  Order order;
  order.options.out = *name;
  const std::string extension = order.options.out.extension().string();
  if (extension != ".pmesh") {
    const auto kind = read_export_kind(order.options.out.string(), ", .pmesh");
    if (!kind) return tl::unexpected(kind.error());
    order.kind = *kind;
  }
  const auto target = read_detail_target(arguments);
  if (!target) return tl::unexpected(target.error());
  if (*target && !order.kind)
    return misused(
        "a .pmesh file contains the whole model; choose another format, or leave out the detail "
        "flag");
  order.options.target = *target;
  if (arguments.has(kTextureFlag.name) && !order.kind)
    return misused("a .pmesh file contains the whole texture; leave out --texture");
  const auto side = read_texture_side(arguments);
  if (!side) return tl::unexpected(side.error());
  order.texture_side = *side;
  if (order.kind) {
    const auto choices = read_export_choices(arguments, order.kind->format);
    if (!choices) return tl::unexpected(choices.error());
    order.choices = *choices;
  } else if (arguments.has(kUnitInFileFlag.name) || arguments.has(kUpInFileFlag.name) ||
             arguments.has(kCompressionFlag.name) || arguments.has(kLodFlag.name)) {
    return misused(
        "a .pmesh file is the model as it is; leave out --unit, --up, --compression and --lod");
  }
  auto url = parse_model_url(arguments.operand(0));
  if (!url) return misused(url.error().message);
  order.options.url = std::move(*url);
  auto token = access_token(arguments);
  if (!token) return tl::unexpected(token.error());
  order.options.token = std::move(*token);
  return order;
}

// Returns the number of bytes to fetch for `target`. For a target in bytes, this is the target
// itself. For other targets, this is the size of the file up to the coarsest level that meets the
// target.
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
    // Counts the triangles at most once per interval, because counting examines every chunk.
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

// Returns the numbers of the pictures that the output needs.
std::vector<std::size_t> pictures_for(const Order& order, const PartialModel& model) {
  const Manifest& manifest = *model.manifest();
  if (order.kind) {
    return pictures_to_export(manifest, triangles_of(model), order.texture_side,
                              roles_in(order.kind->format));
  }
  std::vector<std::size_t> numbers(manifest.texture.pictures.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  return numbers;
}

tl::expected<Fetched, Fault> receive(const Order& order) {
  FetchOptions options = order.options;
  FetchBar bar(options.target);
  options.on_progress = [&](const PartialModel& model) { bar.show(model); };
  auto fetched = fetch(options);
  if (!fetched)
    return failed(fmt::format("{}: {}", options.url.authority(), fetched.error().message));
  const auto pictures =
      fetch_pictures(options, pictures_for(order, fetched->model), fetched->model);
  if (!pictures)
    return failed(fmt::format("{}: {}", options.url.authority(), pictures.error().message));
  fetched->received += *pictures;
  if (order.kind || order.options.target) return std::move(*fetched);
  const auto optional = fetch_optional_blocks(options, fetched->model);
  if (!optional)
    return failed(fmt::format("{}: {}", options.url.authority(), optional.error().message));
  fetched->received += *optional;
  return std::move(*fetched);
}

// Decodes the complete chunks in file order, except those that depend on a missing chunk. Returns
// the mesh file.
Expected<Product> decode_held(const Fetched& fetched, std::span<const std::uint8_t> pmesh,
                              const Order& order) {
  const PartialModel& model = fetched.model;
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
  return exported_mesh(*refiner, pmesh, *order.kind, order.options.out.string(),
                       pictures_for(order, model), order.choices,
                       PresentationTransform(fetched.presentation));
}

// Writes the output file and returns its numbers of faces and vertices.
tl::expected<nlohmann::json, Fault> write_out(const Arguments& arguments, const Fetched& fetched,
                                              const Order& order) {
  const PartialModel& model = fetched.model;
  const std::string out = arguments.text("-o");
  const auto part = InputFile::open(model.path().string());
  if (!part) return failed(part.error());
  if (!order.kind) {
    if (auto written = write_output(out, part->bytes()); !written)
      return tl::unexpected(written.error());
    const LevelInfo& finest = model.manifest()->levels.back();
    return nlohmann::json{{"faces", finest.faces}, {"vertices", finest.vertices}};
  }
  auto product = isolate(
      out, [&](const ProgressReport&) { return decode_held(fetched, part->bytes(), order); });
  if (!product) return tl::unexpected(product.error());
  if (auto written = write_export_or_stdout(arguments, *product); !written)
    return tl::unexpected(written.error());
  return product->report;
}

nlohmann::json promise_json(const PromiseMessage& promise) {
  return {{"level", promise.level},         {"bytes", promise.bytes},
          {"triangles", promise.triangles}, {"error", promise.error},
          {"seconds", promise.seconds},     {"bytes_per_second", promise.bytes_per_second},
          {"measured", promise.is_measured}};
}

CommandOutcome fetch_model(const Arguments& arguments) {
  const auto order = read_order(arguments);
  if (!order) return tl::unexpected(order.error());
  const std::string out = arguments.text("-o");
  if (const auto free = check_output_or_stdout(arguments, out); !free) return failed(free.error());
  const auto fetched = receive(*order);
  if (!fetched) return tl::unexpected(fetched.error());
  const PartialModel& model = fetched->model;
  const auto* want = order->options.target ? std::get_if<Want>(&*order->options.target) : nullptr;
  if (want != nullptr) {
    if (auto met = check_want(*model.manifest(), *want); !met) return failed(met.error());
  }
  auto report = write_out(arguments, *fetched, *order);
  if (!report) return tl::unexpected(report.error());
  std::error_code kept;  // ignored: if the file remains, the next run continues with it
  fs::remove(model.path(), kept);
  (*report)["bytes"] = model.bytes();
  (*report)["received_bytes"] = fetched->received;
  (*report)["level"] = model.level();
  (*report)["error"] = model.manifest()->levels[model.level()].max_error;
  (*report)["seconds"] = fetched->seconds;
  if (fetched->promise) (*report)["promise"] = promise_json(*fetched->promise);
  if (arguments.has("--json")) return print_json(*report, result_stream(out));
  return print(fmt::format("{}: {} faces, {} vertices from {} bytes in {:.2f} s{}", out,
                           (*report)["faces"].get<std::uint64_t>(),
                           (*report)["vertices"].get<std::uint64_t>(), model.bytes(),
                           fetched->seconds, companions_as_text(*report)),
               result_stream(out));
}

constexpr std::string_view kFetchOperands[] = {"URL"};
constexpr FixedText kFetchOutput = concatenate("OUT.{", kExportChoice, ",pmesh}");
constexpr FixedText kFetchFormats =
    concatenate(join(kExportFormats, extension_of, "|", "|"), "|", kZipChoice, "|pmesh");
constexpr FixedText kFetchDetails = concatenate(
    "URL is the address of a model's page, such as https://museum.example/models/ID. The name of "
    "OUT chooses the format. --level, --triangles, --bytes, --error, --seconds and --view exclude "
    "each other; without any, the whole model is fetched. An interrupted fetch continues when the "
    "command is run again. ",
    kNoteOnCompanions);
constexpr Flag kFetchFlags[] = {
    {"-o", kFetchOutput,
     "file to write (required); - is standard output. An interrupted download is kept beside it, "
     "or for - in the current folder"},
    {kOutputFormat, kFetchFormats, kOutputFormatHelp},
    {"--level", "L",
     "level of detail; 0 is the coarsest; the manifest lists the levels "
     "(/api/v1/models/ID/manifest)"},
    {"--triangles", "N", "finest mesh with at most N triangles"},
    {"--bytes", "B", "finest mesh in the first B bytes of the file"},
    {"--error", "E", "coarsest level within E of the original, in the model's unit"},
    {"--seconds", "S", "finest mesh that arrives within S seconds"},
    {"--view", "FILE.json",
     "detail for a camera, a JSON object: camera (16 numbers, by columns: the matrix from the "
     "camera, which looks along -z with y up, to the model, in its unit), fov (degrees from bottom "
     "to top), width and height (of the picture, in pixels), pixels (greatest visible error, in "
     "pixels) and, optionally, bytes (most bytes to fetch)"},
    kTextureFlag,
    kUnitInFileFlag,
    kUpInFileFlag,
    kCompressionFlag,
    kLodFlag,
    {"--token", "T", "token of role viewer or higher, for unpublished models"},
    kTokenFileFlag,
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kFetch = {
    .name = "fetch",
    .summary = "Fetches a model from a server, at full or reduced detail.",
    .details = kFetchDetails,
    .operands = kFetchOperands,
    .flags = kFetchFlags,
    .examples = "vitrine fetch https://museum.example/models/ID -o bust.glb --triangles 50000",
    .run = fetch_model};

}  // namespace vitrine::server::cli
