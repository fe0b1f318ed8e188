// SPDX-License-Identifier: Apache-2.0
#include "codec/build/verify_model.h"

#include <fmt/core.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/companion_files.h"
#include "server/cli/support/console.h"
#include "server/cli/support/input.h"
#include "server/cli/support/isolation.h"
#include "server/cli/support/reading.h"

namespace vitrine::server::cli {
namespace {

using nlohmann::json;

json describe(const Verification& v) {
  return {{"ok", v.is_lossless.value_or(true)},
          {"lossless", v.is_lossless.has_value() ? json(*v.is_lossless) : json()},
          {"levels", v.levels},
          {"chunks", v.chunks},
          {"pictures", v.pictures},
          {"originals", v.has_originals},
          {"vertices", v.vertices},
          {"faces", v.faces},
          {"orders", v.orders}};
}

std::string verdict(const json& report) {
  const auto pictures = report["pictures"].get<std::uint64_t>();
  return fmt::format(
      "ok: {} levels and {} chunks{}{}, {} vertices, {} faces, decoded in {} order(s){}",
      report["levels"].get<std::uint64_t>(), report["chunks"].get<std::uint64_t>(),
      pictures > 0 ? fmt::format(", {} picture(s)", pictures) : std::string(),
      report["originals"].get<bool>() ? ", the source's originals" : "",
      report["vertices"].get<std::uint64_t>(), report["faces"].get<std::uint64_t>(),
      report["orders"].get<std::uint64_t>(), report["lossless"].is_null() ? "" : "; lossless");
}

CommandOutcome report_fault(bool as_json, const Fault& fault) {
  if (as_json) {
    const json report = {{"ok", false}, {"lossless", nullptr}, {"error", fault.message}};
    if (auto printed = print_json(report); !printed) return printed;
  }
  return tl::unexpected(fault);
}

CommandOutcome verify(const Arguments& arguments) {
  auto reading = reading_options(arguments);
  if (!reading) return tl::unexpected(reading.error());
  const std::string path = arguments.operand(0);
  const auto file = InputFile::open(path);
  if (!file) return failed(file.error());
  std::optional<InputFile> input;
  std::optional<CompanionFiles> companions;
  if (arguments.has("--against")) {
    auto opened = InputFile::open_mesh(arguments.text("--against"));
    if (!opened) return failed(opened.error());
    input.emplace(std::move(*opened));
    companions.emplace(arguments.text("--against"), input->bytes());
    reading->beside = companions->contents();
  }
  const auto product = isolate(path, [&](const ProgressReport& progress) -> Expected<Product> {
    std::optional<OriginalFile> against;
    if (input) against = {.bytes = input->bytes(), .reading = *reading};
    const auto result = verify_model(file->bytes(), against, progress);
    if (!result) return tl::unexpected(result.error());
    return Product{describe(*result), {}};
  });
  const bool as_json = arguments.has("--json");
  if (!product) return report_fault(as_json, product.error());
  const bool good = product->report["ok"].get<bool>();
  if (as_json || good) {
    auto printed = as_json ? print_json(product->report) : print(verdict(product->report));
    if (!printed || good) return printed;
  }
  return failed(fmt::format(
      "{} is intact but was not built from {} with {} up; give the --up that it was built with, or "
      "build it again from that file",
      path, arguments.text("--against"), arguments.text("--up", "y")));
}

constexpr std::string_view kVerifyOperands[] = {"FILE.pmesh"};
constexpr Flag kVerifyFlags[] = {{"--against", "IN",
                                  "mesh that the file was built from; checks that the finest "
                                  "level has the same surface, and that the file keeps the mesh's "
                                  "own materials, pictures and texture coordinates unchanged"},
                                 {"--up", "y|z",
                                  "with --against: the value of --up with which the file was built "
                                  "(default y)"},
                                 {"--json", "", "print the result as one JSON object"}};

}  // namespace

const Command kVerify = {.name = "verify",
                         .summary = "Decodes and checks all parts of a .pmesh file.",
                         .operands = kVerifyOperands,
                         .flags = kVerifyFlags,
                         .examples = "vitrine verify bust.pmesh --against bust.ply",
                         .run = verify};

}  // namespace vitrine::server::cli
