// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <thread>

#include "codec/files/atomic_file.h"
#include "server/cli/command.h"
#include "server/cli/companion_files.h"
#include "server/cli/console.h"
#include "server/cli/input.h"
#include "server/cli/isolation.h"
#include "server/cli/levels.h"
#include "server/cli/reading.h"
#include "server/jobs/build_model.h"
#include "server/report/build_report.h"

namespace vitrine::cli {
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

// `m` is the header as a reader of the file sees it.
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
  for (const json& repair : report["input"]["repairs"]) {
    text += fmt::format("repaired: {}\n", repair.get<std::string>());
  }
  return text + fmt::format("{}: {} bytes, {:.2f} bits per vertex; {}\n\n{}", out,
                            manifest.file_bytes, report["bits_per_vertex"].get<double>(),
                            lattice_text(manifest), levels_text(manifest));
}

// Whether all outputs can be written, asked before long work.
Outcome check_outputs(const Arguments& arguments) {
  const std::string path = arguments.operand(0), page = arguments.text("--report");
  std::vector<std::string> outputs = {arguments.text("-o")};
  if (arguments.has("--report")) outputs.push_back(page);
  for (const std::string& out : outputs) {
    if (const auto writable = check_writable(out); !writable) return failed(writable.error());
    if (const auto distinct = check_distinct(path, out); !distinct) return failed(distinct.error());
  }
  using std::filesystem::weakly_canonical;
  std::error_code unknown;  // then writing fails too
  if (outputs.size() == 2 &&
      weakly_canonical(outputs[0], unknown) == weakly_canonical(outputs[1], unknown)) {
    return misused("-o and --report name the same file; choose another name for the report");
  }
  return {};
}

// Of the time that a build with a report takes, the build itself.
constexpr double kBuilt = 0.25;

// Reports from `from` to `to` of the whole what the work reports from 0 to 1.
ProgressReport part_of(const ProgressReport& whole, double from, double to) {
  return [&whole, from, to](std::string_view stage, double done) {
    whole(stage, std::lerp(from, to, done));
  };
}

Expected<Product> make(std::span<const std::uint8_t> input, const BuildOptions& options,
                       const std::optional<std::string>& report_of,
                       const ProgressReport& progress) {
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

Outcome write_outputs(const Arguments& arguments, const Product& product) {
  const auto written = write_file_atomically(arguments.text("-o"), product.file);
  if (!written) return failed(written.error());
  if (!arguments.has("--report")) return {};
  const auto reported = write_file_atomically(
      arguments.text("--report"),
      {reinterpret_cast<const std::uint8_t*>(product.page.data()), product.page.size()});
  if (reported) return {};
  return failed(
      fmt::format("{} ('{}' is written)", reported.error().message, arguments.text("-o")));
}

Outcome build(const Arguments& arguments) {
  if (!arguments.has("-o")) return misused("-o is missing; name the output file");
  if (!arguments.text("-o").ends_with(".pmesh")) {
    return misused(
        "the output's name must end in .pmesh; vitrine decode makes meshes of that file");
  }
  auto options = read_options(arguments);
  if (!options) return tl::unexpected(options.error());
  const std::string path = arguments.operand(0), out = arguments.text("-o");
  if (auto ok = check_outputs(arguments); !ok) return ok;
  const auto file = InputFile::open_mesh(path);
  if (!file) return failed(file.error());
  const CompanionFiles companions(path, file->bytes());
  options->reading.beside = companions.contents();

  std::optional<std::string> report_of;
  if (arguments.has("--report")) report_of = std::filesystem::path(path).filename().string();
  const SpillOptions spill{.folder = folder_of(out), .input = file->bytes()};
  auto product = isolate(
      path,
      [&](const ProgressReport& progress) {
        return make(file->bytes(), *options, report_of, progress);
      },
      spill);
  if (!product) return tl::unexpected(product.error());
  const auto start = Clock::now();
  if (auto written = write_outputs(arguments, *product); !written) return written;
  json& seconds = product->report["seconds"]["write"];
  seconds = seconds.get<double>() + std::chrono::duration<double>(Clock::now() - start).count();
  if (arguments.has("--json")) return print_json(product->report);
  const auto manifest = parse_header(product->file);
  if (!manifest) return failed(manifest.error());
  return print(as_text(product->report, *manifest, out));
}

constexpr std::string_view kBuildOperands[] = {"IN"};
constexpr Flag kBuildFlags[] = {
    {"-o", "OUT.pmesh", "the file to write"},
    kUnitFlag,
    kUpFlag,
    {"--bits", "auto|10..16", "grid of the coordinates (default auto)"},
    {"--placement", "midpoint|pyramid",
     "smallest file, or the paper's own vertices (default midpoint)"},
    {"--order", "batch|heap", "few large levels, or the cheapest pair first (default batch)"},
    {"--threads", "N", "default: one for each core"},
    {"--report", "OUT.html", "also write a page: pictures, error against bytes, all levels"},
    {"--json", "", "print one JSON object"}};

}  // namespace

const Command kBuild = {"build", "Builds a .pmesh file from a PLY, OBJ, STL, OFF or GLB mesh.",
                        kBuildOperands, kBuildFlags, build};

}  // namespace vitrine::cli
