// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "codec/import/read_mesh.h"
#include "codec/mesh/surface_distance.h"
#include "codec/mesh/unit.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/input.h"
#include "server/cli/isolation.h"
#include "server/jobs/open_model.h"

namespace vitrine::cli {
namespace {

using nlohmann::json;

struct Surface {
  TriangleMesh mesh;
  std::string unit;  // empty where it is unknown
};

Expected<Surface> read_surface(const InputFile& file) {
  if (!file.is_pmesh()) {
    auto imported = read_mesh(file.bytes());
    if (!imported) return tl::unexpected(imported.error());
    return Surface{std::move(imported->mesh), std::move(imported->unit)};
  }
  auto refiner = open_model(file.bytes());
  if (!refiner) return tl::unexpected(refiner.error());
  const Manifest& manifest = refiner->manifest();
  const WantLevel finest{static_cast<std::uint32_t>(manifest.levels.size() - 1)};
  const auto refined = refine(*refiner, finest, chunks_of(manifest, file.bytes()));
  if (!refined) return tl::unexpected(refined.error());
  return Surface{refiner->display_mesh(), manifest.unit};
}

// Only where both units are known: otherwise the numbers are compared as they are.
void convert(Surface& surface, std::string_view unit) {
  const auto from = metres_per(surface.unit), to = metres_per(unit);
  if (!from || !to || *from == *to) return;
  for (Vec3& p : surface.mesh.positions)
    p = p * (*from / *to);
}

// What to know of units before trusting the numbers; empty where they are as good as they look.
std::string note_on_units(const Surface& a, const Surface& b) {
  if (a.unit.empty() == b.unit.empty()) return {};
  const bool first = a.unit.empty();
  return fmt::format(
      "{} states no unit and {} is in {}: their numbers are compared as they are; if they differ, "
      "build a model of {} with --unit and measure that",
      first ? "A" : "B", first ? "B" : "A", first ? b.unit : a.unit, first ? "A" : "B");
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

std::string distances(const json& r) {
  const auto line = [](const char* name, const json& d) {
    return fmt::format("\n{}: rms {:.6g}, p95 {:.6g}, max {:.6g}", name, d["rms"].get<double>(),
                       d["p95"].get<double>(), d["max"].get<double>());
  };
  return fmt::format("rms {:.6g} ({:.4g} % of B's diagonal), max {:.6g} ({:.4g} %)",
                     r["rms"].get<double>(), r["rms_percent"].get<double>(), r["max"].get<double>(),
                     r["max_percent"].get<double>()) +
         line("A to B", r["a_to_b"]) + line("B to A", r["b_to_a"]);
}

Outcome run_measure(const Arguments& arguments) {
  MeasureOptions options{.align = arguments.has("--align")};
  const auto samples = arguments.number("--samples", 1, 100'000'000);
  if (!samples) return tl::unexpected(samples.error());
  options.samples = samples->value_or(options.samples);
  const auto a = InputFile::open(arguments.operand(0)), b = InputFile::open(arguments.operand(1));
  if (!a) return failed(a.error());
  if (!b) return failed(b.error());

  const auto read = [](const InputFile& file, const std::string& name) {
    return read_surface(file).map_error([&](const Error& error) {
      return Error{error.code, name + ": " + error.message};
    });
  };
  const auto product = isolate("cannot measure", [&](const ProgressReport&) -> Expected<Product> {
    auto first = read(*a, arguments.operand(0));
    if (!first) return tl::unexpected(first.error());
    const auto second = read(*b, arguments.operand(1));
    if (!second) return tl::unexpected(second.error());
    const std::string note = note_on_units(*first, *second);
    convert(*first, second->unit);
    const auto distance = measure(first->mesh, second->mesh, options);
    if (!distance) return tl::unexpected(distance.error());
    json report = describe(*distance);
    if (!note.empty()) report["note"] = note;
    return Product{std::move(report), {}};
  });
  if (!product) return tl::unexpected(product.error());
  if (product->report.contains("note")) print_note(product->report["note"].get<std::string>());
  return arguments.has("--json") ? print_json(product->report) : print(distances(product->report));
}

constexpr std::string_view kMeasureOperands[] = {"A", "B"};
constexpr Flag kMeasureFlags[] = {{"--samples", "N", "points on each surface (default 200000)"},
                                  {"--align", "", "first move A onto B: rigid, without scale"},
                                  {"--json", "", "print one JSON object"}};

}  // namespace

const Command kMeasure = {"measure",
                          "Measures the distance between two surfaces, both ways, in B's unit.",
                          kMeasureOperands, kMeasureFlags, run_measure};

}  // namespace vitrine::cli
