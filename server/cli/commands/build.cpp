// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <thread>

#include "codec/build/build_model.h"
#include "codec/files/atomic_file.h"
#include "codec/import/formats.h"
#include "server/cli/commands/command.h"
#include "server/cli/report/build_report.h"
#include "server/cli/support/companion_files.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/levels.h"
#include "server/cli/support/output.h"
#include "server/cli/support/reading.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

tl::expected<int, Fault> read_bits(const Arguments& arguments) {
  if (arguments.text("--bits", "auto") == "auto") return 0;
  const auto bits = arguments.number("--bits", kMinBits, kMaxBits);
  if (!bits) {
    return arguments.wrong_value("--bits", fmt::format("auto or {} to {}", kMinBits, kMaxBits));
  }
  return static_cast<int>(**bits);
}

tl::expected<BuildOptions, Fault> read_options(const Arguments& arguments) {
  const auto bits = read_bits(arguments);
  if (!bits) return tl::unexpected(bits.error());
  constexpr std::string_view kPlacements[] = {"midpoint", "pyramid"};
  const auto placement = arguments.choice("--placement", kPlacements);
  if (!placement) return tl::unexpected(placement.error());
  constexpr std::string_view kOrders[] = {"batch", "heap"};
  const auto order = arguments.choice("--order", kOrders);
  if (!order) return tl::unexpected(order.error());
  const auto threads = arguments.number("--threads", 1, 256);
  if (!threads) return tl::unexpected(threads.error());
  const auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  BuildOptions options;
  options.reading = *reading;
  options.bits = *bits;
  options.placement = *placement == 1 ? Placement::kPyramid : Placement::kMidpoint;
  options.order = *order == 1 ? CollapseOrder::kHeap : CollapseOrder::kBatch;
  options.threads =
      static_cast<unsigned>(threads->value_or(std::max(1u, std::thread::hardware_concurrency())));
  return options;
}

std::uint64_t peak_memory() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// Describes the result of a build as JSON. `m` is the header as read from the file.
json describe(const BuildReport& report, const Manifest& m) {
  const auto& [read, simplify, encode, write] = report.seconds;
  return {
      {"input",
       {{"vertices", report.input.vertices},
        {"faces", report.input.faces},
        {"boundary_edges", report.input.boundary_edges},
        {"components", report.input.components},
        {"repairs", report.input.repairs}}},
      {"bits", m.lattice.bits},
      {"unit", m.unit},
      {"bytes", bytes_json(m)},
      {"bits_per_vertex", 8.0 * static_cast<double>(m.file_bytes) / m.levels.back().vertices},
      {"levels", levels_json(m)},
      {"seconds", {{"read", read}, {"simplify", simplify}, {"encode", encode}, {"write", write}}},
      {"peak_rss_bytes", peak_memory()}};
}

std::string as_text(const json& report, const Manifest& manifest, const std::string& out) {
  std::string text;
  for (const json& line : report["input"]["repairs"]) {
    const auto repair = line.get<std::string>();
    const bool is_note = repair.ends_with("no step is needed");  // nothing was lost or changed
    text += fmt::format("{}: {}\n", is_note ? "note" : "repaired", repair);
  }
  return text + fmt::format("{}: {} bytes, {:.2f} bits per vertex; {}\n\n{}", out,
                            manifest.file_bytes, report["bits_per_vertex"].get<double>(),
                            lattice_text(manifest), levels_text(manifest));
}

// Checks that all outputs can be written, before the long work begins.
CommandOutcome check_outputs(const Arguments& arguments, const std::string& path) {
  const std::string page = arguments.text("--report");
  std::vector<std::string> outputs = {arguments.text("-o")};
  if (arguments.has("--report")) outputs.push_back(page);
  for (const std::string& out : outputs) {
    if (const auto distinct = check_distinct(path, out); !distinct) return failed(distinct.error());
    if (const auto free = check_output_or_stdout(arguments, out); !free)
      return failed(free.error());
  }
  if (page == kStandardStream) return misused("--report cannot be standard output; name a file");
  using std::filesystem::weakly_canonical;
  std::error_code unknown;  // ignored: writing the outputs will report the error
  if (outputs.size() == 2 &&
      weakly_canonical(outputs[0], unknown) == weakly_canonical(outputs[1], unknown)) {
    return misused("-o and --report name the same file; choose another name for the report");
  }
  return {};
}

// Share of the total progress that the build takes if a report page is made, too.
constexpr double kBuilt = 0.25;

// Returns a progress report for one part of the work. It converts the part's progress from 0..1 to
// `from`..`to`, and passes the result to `whole`.
ProgressReport part_of(const ProgressReport& whole, double from, double to) {
  return [&whole, from, to](std::string_view stage, double done) {
    whole(stage, std::lerp(from, to, done));
  };
}

Expected<Product> make(std::span<const std::uint8_t> input, const ImportFormat* format,
                       const BuildOptions& options, const std::optional<std::string>& report_of,
                       const ProgressReport& progress) {
  if (auto ok = check_format(input, format); !ok) return tl::unexpected(ok.error());
  const double built = report_of ? kBuilt : 1;
  auto result = build_model(input, options, part_of(progress, 0, built));
  if (!result) return tl::unexpected(result.error());
  const auto manifest = parse_header(result->file);
  if (!manifest) return tl::unexpected(manifest.error());
  std::string page;
  if (report_of) {
    auto written =
        build_report(*report_of, input, options.reading, *result, part_of(progress, built, 1));
    if (!written) return tl::unexpected(written.error());
    page = std::move(*written);
  }
  json report = describe(result->report, *manifest);
  if (auto note = note_on_unit(input, options.reading); !note.empty()) report["note"] = note;
  return Product{std::move(report), std::move(result->file), std::move(page)};
}

CommandOutcome write_outputs(const Arguments& arguments, const Product& product) {
  if (auto written = write_output(arguments.text("-o"), product.file); !written) return written;
  if (!arguments.has("--report")) return {};
  const auto reported = write_file_atomically(
      arguments.text("--report"),
      {reinterpret_cast<const std::uint8_t*>(product.page.data()), product.page.size()});
  if (reported) return {};
  return failed(
      fmt::format("{} ('{}' is written)", reported.error().message, arguments.text("-o")));
}

CommandOutcome check_name(const Arguments& arguments) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  const std::string out = arguments.text("-o");
  if (out == kStandardStream || out.ends_with(".pmesh")) return {};
  return misused(
      "the output's name must end in .pmesh; vitrine decode then writes meshes from that file");
}

// Returns the folder for the spill file, which holds data that does not fit into memory.
std::filesystem::path spill_folder(const std::string& out) {
  std::error_code unknown;  // ignored: the path is then empty, and all data stay in memory
  return out == kStandardStream ? std::filesystem::temp_directory_path(unknown) : folder_of(out);
}

CommandOutcome build(const Arguments& arguments) {
  if (auto ok = check_name(arguments); !ok) return ok;
  const auto format = stated_format(arguments);
  if (!format) return tl::unexpected(format.error());
  auto options = read_options(arguments);
  if (!options) return tl::unexpected(options.error());
  const auto model = ModelPath::of(arguments.operand(0));
  if (!model) return failed(model.error());
  const std::string path = model->file, out = arguments.text("-o");
  if (auto ok = check_outputs(arguments, path); !ok) return ok;
  const auto file = InputFile::open_mesh(path);
  if (!file) return failed(file.error());
  const CompanionFiles companions(*model, file->bytes());
  options->reading.beside = companions.contents();
  options->reading.name = path;

  std::optional<std::string> report_of;
  if (arguments.has("--report"))
    report_of = std::filesystem::path(input_name(path)).filename().string();
  const SpillOptions spill{.folder = spill_folder(out), .input = file->bytes()};
  auto product = isolate(
      path,
      [&](const ProgressReport& progress) {
        return make(file->bytes(), *format, *options, report_of, progress);
      },
      spill);
  if (!product) return tl::unexpected(product.error());
  const auto start = Clock::now();
  if (auto written = write_outputs(arguments, *product); !written) return written;
  json& seconds = product->report["seconds"]["write"];
  seconds = seconds.get<double>() + std::chrono::duration<double>(Clock::now() - start).count();
  if (arguments.has("--json")) return print_json(product->report, result_stream(out));
  const auto manifest = parse_header(product->file);
  if (!manifest) return failed(manifest.error());
  return print(as_text(product->report, *manifest, out), result_stream(out));
}

constexpr std::string_view kBuildOperands[] = {"IN"};
constexpr Flag kBuildFlags[] = {
    {"-o", "OUT.pmesh", "model file to write (required); - is standard output"},
    kFormatFlag,
    kUnitFlag,
    kUpFlag,
    {"--bits", "auto|10..16",
     "resolution of the grid of vertex positions, in bits per coordinate (default auto: chosen "
     "from the median edge length)"},
    {"--placement", "midpoint|pyramid",
     "place of the vertex of a collapsed edge: midpoint (default; smaller file) or, for "
     "comparison, pyramid (the method of Wang, Li and Li); see codec/README.md"},
    {"--order", "batch|heap",
     "order of edge collapses: batch, many at once (default; smaller file), or heap, one at "
     "a time, the cheapest first"},
    {"--threads", "N", "number of threads (default: one per core)"},
    {"--report", "OUT.html",
     "also write a page with pictures, a plot of error against bytes, and all levels"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object"}};

constexpr FixedText kBuildSummary =
    concatenate("Builds a .pmesh file from a ", kImportFormatNames,
                " mesh, or from a package of a mesh and its pictures (zip, tar or gzip).");

}  // namespace

const Command kBuild = {
    .name = "build",
    .summary = kBuildSummary,
    .details =
        "IN may be a folder with one model, or -, which is standard input. Files to which IN "
        "refers must be in its folder or a subfolder; if IN is -, in the current folder. With -o "
        "-, the model goes to standard output, and the summary to standard error.",
    .operands = kBuildOperands,
    .flags = kBuildFlags,
    .examples =
        "vitrine build bust.ply -o bust.pmesh\nvitrine build scan.obj -o "
        "scan.pmesh --unit mm --up z --report scan.html\nxz -dc bust.ply.xz | vitrine "
        "build - -o - | ssh museum 'cat > bust.pmesh'",
    .run = build};

}  // namespace vitrine::server::cli
