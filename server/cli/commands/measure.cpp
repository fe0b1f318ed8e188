// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "codec/appearance/appearance.h"
#include "codec/distance/distance_map.h"
#include "codec/distance/surface_distance.h"
#include "codec/export/write_mesh.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/companion_files.h"
#include "server/cli/support/console.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/notes.h"
#include "server/cli/support/output.h"
#include "server/cli/support/reading.h"
#include "server/cli/support/surface_file.h"
#include "server/cli/support/surface_textures.h"
#include "server/export/export_choices.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

constexpr std::string_view kBetweenNotes = "; ";

// Returns a note if the units of the surfaces make the numbers doubtful. Otherwise returns an empty
// text.
std::string note_on_units(const SurfaceInput& a, const SurfaceInput& b) {
  if (a.unit.empty() == b.unit.empty()) return {};
  const bool first = a.unit.empty();
  return fmt::format(
      "{} states no unit, and {} is in {}: the coordinates are compared as they are; if the units "
      "differ, build a model of {} with --unit and measure that",
      first ? "A" : "B", first ? "B" : "A", first ? b.unit : a.unit, first ? "A" : "B");
}

// Returns a note for each kind of material or picture of A and B that is not compared.
std::vector<std::string> notes_on_looks(const SurfaceInput& a, const SurfaceInput& b) {
  std::vector<std::string> notes;
  for (const std::string& line : a.not_carried)
    notes.push_back("A: " + line);
  for (const std::string& line : b.not_carried)
    notes.push_back("B: " + line);
  return notes;
}

// Joins the reasons to doubt the numbers into one note. Returns an empty text if there are none.
std::string notes_on(const SurfaceInput& a, const SurfaceInput& b) {
  std::vector<std::string> notes = notes_on_looks(a, b);
  notes.push_back(note_on_units(a, b));
  return join_notes(std::move(notes), kBetweenNotes);
}

json one_way(const OneWayDistance& d) {
  return {{"rms", d.rms}, {"p95", d.p95}, {"max", d.max}};
}

json describe(const SurfaceDistance& d) {
  return {{"rms", d.rms},
          {"max", d.max},
          {"rms_percent", d.rms_percent},
          {"max_percent", d.max_percent},
          {"a_to_b", one_way(d.a_to_b)},
          {"b_to_a", one_way(d.b_to_a)}};
}

// Describes the map's colours. The distances have the same unit as the measured numbers.
std::string legend(const json& map) {
  return fmt::format(
      "\n{0}: A's surface, red where it lies {1:.6g} or more outside B, blue where it lies {1:.6g} "
      "or more inside B, grey where both agree",
      map["file"].get<std::string>(), map["range"].get<double>());
}

std::string distances(const json& r) {
  const auto line = [](const char* name, const json& d) {
    return fmt::format("\n{}: rms {:.6g}, p95 {:.6g}, max {:.6g}", name, d["rms"].get<double>(),
                       d["p95"].get<double>(), d["max"].get<double>());
  };
  return fmt::format("rms {:.6g} ({:.4g} % of B's diagonal), max {:.6g} ({:.4g} %)",
                     r["rms"].get<double>(), r["rms_percent"].get<double>(), r["max"].get<double>(),
                     r["max_percent"].get<double>()) +
         line("A to B", r["a_to_b"]) + line("B to A", r["b_to_a"]) +
         (r.contains("map") ? legend(r["map"]) : "");
}

std::string likeness(const json& r) {
  const std::string psnr = r["psnr"].is_null() ? "the pictures are equal"
                                               : fmt::format("{:.2f} dB", r["psnr"].get<double>());
  return fmt::format("PSNR: {}\nSSIM: {:.4f}", psnr, r["ssim"].get<double>());
}

// One way to compare two surfaces, for example by their distance.
struct Measure {
  std::function<Expected<Product>(SurfaceInput a, SurfaceInput b)> compare;
  std::string (*as_text)(const json& report);
  SurfaceParts parts = SurfaceParts::kShape;  // parts of the models that `compare` needs
};

struct MapTarget {
  std::string file;
  MeshFormat format;
  std::optional<double> range;  // distance of the strongest colour, in B's unit
};

struct DistanceTask {
  MeasureOptions options;
  bool aligns = false;
  std::optional<MapTarget> map;
};

Expected<void> add_map(Product& product, const TriangleMesh& a, const SurfaceInput& b,
                       const MapTarget& target) {
  const auto map = distance_map(a, b.mesh, target.range);
  if (!map) return tl::unexpected(map.error());
  auto file =
      write_mesh(map->mesh, target.format, {.unit = b.unit, .about = {.title = "Distance map"}});
  if (!file) return tl::unexpected(file.error());
  product.file = *std::move(file);
  const std::string note = join_notes(
      {note_on_unknown_unit(target.format, b.unit), note_on_precision(map->mesh, target.format)},
      kBetweenNotes);
  if (!note.empty()) product.report["note"] = note;
  product.report["map"] = {{"file", target.file}, {"range", map->range}};
  return {};
}

Expected<Product> compare_distances(SurfaceInput a, const SurfaceInput& b,
                                    const DistanceTask& task) {
  if (task.aligns) {
    auto moved = aligned(a.mesh, b.mesh);
    if (!moved) return tl::unexpected(moved.error());
    a.mesh = *std::move(moved);
  }
  const auto distance = measure(a.mesh, b.mesh, task.options);
  if (!distance) return tl::unexpected(distance.error());
  Product product{describe(*distance), {}};
  if (task.map)
    if (const auto added = add_map(product, a.mesh, b, *task.map); !added)
      return tl::unexpected(added.error());
  return product;
}

Expected<Product> compare_looks(SurfaceInput a, SurfaceInput b) {
  const auto own = take_textures(a), others = take_textures(b);
  if (!own) return tl::unexpected(own.error());
  if (!others) return tl::unexpected(others.error());
  const auto found = compare_appearance({.mesh = a.mesh, .textures = own->get()},
                                        {.mesh = b.mesh, .textures = others->get()});
  return found.map([](const Appearance& appearance) {
    return Product{
        {{"psnr", appearance.psnr ? json(*appearance.psnr) : json()}, {"ssim", appearance.ssim}},
        {}};
  });
}

bool has_colours(MeshFormat format) {
  return format != MeshFormat::kStl;
}

// Reads --map and --range. Returns nullopt if no map is wanted.
tl::expected<std::optional<MapTarget>, Fault> map_from(const Arguments& arguments) {
  const auto range = arguments.distance("--range");
  if (!range) return tl::unexpected(range.error());
  if (*range == 0.0) return arguments.wrong_value("--range", "a distance above 0");
  if (!arguments.has("--map")) {
    if (!*range) return std::nullopt;
    return misused("--range needs --map; name the map's file");
  }
  const std::string file = arguments.text("--map");
  const auto format = format_of_extension(std::filesystem::path(file).extension().string());
  if (!format || !has_colours(*format))
    return arguments.wrong_value("--map", "a file of a format with colours, such as map.ply");
  if (const auto free = check_output(arguments, file); !free) return failed(free.error());
  return MapTarget{file, *format, *range};
}

tl::expected<Measure, Fault> distance_measure(const Arguments& arguments) {
  DistanceTask task{.aligns = arguments.has("--align")};
  const auto samples = arguments.number("--samples", 1, 100'000'000);
  if (!samples) return tl::unexpected(samples.error());
  task.options.samples = samples->value_or(task.options.samples);
  auto map = map_from(arguments);
  if (!map) return tl::unexpected(map.error());
  task.map = *std::move(map);
  return Measure{[task](SurfaceInput a, const SurfaceInput& b) {
                   return compare_distances(std::move(a), b, task);
                 },
                 distances};
}

tl::expected<Measure, Fault> measure_from(const Arguments& arguments) {
  if (!arguments.has("--appearance")) return distance_measure(arguments);
  for (const char* flag : {"--align", "--samples", "--map", "--range"})
    if (arguments.has(flag))
      return misused(fmt::format("{} and --appearance exclude each other; leave one out", flag));
  return Measure{compare_looks, likeness, SurfaceParts::kLooks};
}

// The file of a surface, and the files beside it that contain required parts, such as pictures.
class MeasuredFile {
 public:
  MeasuredFile(std::string name, InputFile file, SurfaceParts parts)
      : name_(std::move(name)),
        file_(std::move(file)),
        parts_(parts),
        beside_(name_, file_.bytes(),
                parts == SurfaceParts::kLooks ? CompanionKinds::kAll : CompanionKinds::kBuffers) {}

  Expected<SurfaceInput> read(ReadOptions options) const {
    options.beside = beside_.contents();
    options.name = name_;
    return read_surface(file_, name_, options, parts_);
  }

 private:
  std::string name_;
  InputFile file_;
  SurfaceParts parts_;
  CompanionFiles beside_;
};

Expected<MeasuredFile> open_measured(const std::string& name, SurfaceParts parts) {
  return InputFile::open(name).map(
      [&](InputFile&& file) { return MeasuredFile(name, std::move(file), parts); });
}

Expected<Product> compare(const MeasuredFile& a, const MeasuredFile& b, const ReadOptions& options,
                          const Measure& measure) {
  auto first = a.read(options);
  if (!first) return tl::unexpected(first.error());
  auto second = b.read(options);
  if (!second) return tl::unexpected(second.error());
  const std::string note = notes_on(*first, *second);
  convert(*first, second->unit);
  auto product = measure.compare(*std::move(first), *std::move(second));
  if (!product) return product;
  const std::string notes = join_notes({note, product->report.value("note", "")}, kBetweenNotes);
  if (!notes.empty()) product->report["note"] = notes;
  return product;
}

CommandOutcome run_measure(const Arguments& arguments) {
  const auto chosen = measure_from(arguments);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  const auto a = open_measured(arguments.operand(0), chosen->parts),
             b = open_measured(arguments.operand(1), chosen->parts);
  if (!a) return failed(a.error());
  if (!b) return failed(b.error());
  const auto product = isolate(
      "cannot measure", [&](const ProgressReport&) { return compare(*a, *b, *reading, *chosen); });
  if (!product) return tl::unexpected(product.error());
  if (arguments.has("--map"))
    if (auto written = write_output(arguments.text("--map"), product->file); !written)
      return written;
  return arguments.has("--json") ? print_json(product->report)
                                 : print(chosen->as_text(product->report));
}

constexpr std::string_view kMeasureOperands[] = {"A", "B"};
constexpr Flag kMeasureFlags[] = {
    {"--samples", "N", "number of sample points on each surface (default 200000)"},
    {"--up", "y|z", "axis of mesh files that points up (default y), as for vitrine build"},
    {"--align", "", "first align A to B by a rotation and a translation, without scaling"},
    {"--appearance", "",
     "compare pictures of both models from twelve sides instead of distances: peak signal-to-noise "
     "ratio (psnr, dB; null if the pictures are equal) and structural similarity (ssim; 1 if "
     "equal)"},
    {"--map", "OUT",
     "also write A's surface with a colour for the distance to B: grey where both agree, red where "
     "A lies outside B, blue where it lies inside; OUT is a mesh file as for vitrine decode, but "
     "not .stl"},
    {"--range", "D",
     "with --map: distance, in B's unit, from which red and blue are strongest; default: the "
     "distance that 95 % of A's vertices do not exceed, or the largest if over 95 % lie on B"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kMeasure = {
    .name = "measure",
    .summary =
        "Measures the distance between two surfaces in both directions, or compares their "
        "appearance.",
    .details =
        "A and B are mesh files, or .pmesh files, whose finest level is measured. A is converted "
        "to B's unit, in which the result is. If only one of them states a unit, coordinates are "
        "compared as they are, and a note says so.",
    .operands = kMeasureOperands,
    .flags = kMeasureFlags,
    .examples =
        "vitrine measure small.ply bust.ply\nvitrine measure after.ply before.ply --align "
        "--map change.ply",
    .run = run_measure};

}  // namespace vitrine::server::cli
