// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/isolation.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <sstream>

#include "server/cli/support/console.h"
#include "server/cli/support/input.h"

namespace vitrine::server::cli {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Returns the limits of the sandbox. The sandbox may use all memory of the machine, because users
// run these commands for themselves and can stop them.
SandboxLimits limits(const SpillOptions& spill) {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  SandboxLimits limits;
  limits.memory_bytes = std::max(limits.memory_bytes, pages * page);
  limits.answer_bytes = limits.memory_bytes;
  limits.cpu_seconds = 24 * 3600;
  limits.wall = std::chrono::hours(24);
  limits.spill = spill;
  return limits;
}

constexpr std::string_view kNoAnswer =
    "the isolated process returned no result; run the command again";

// Appends the length of `part`, then its bytes.
void add_part(Bytes& bytes, std::span<const std::uint8_t> part) {
  const std::uint64_t length = part.size();
  const auto* digits = reinterpret_cast<const std::uint8_t*>(&length);
  bytes.insert(bytes.end(), digits, digits + sizeof length);
  bytes.insert(bytes.end(), part.begin(), part.end());
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Removes the first part from `bytes` and returns it. Returns nullopt if the part is incomplete.
std::optional<std::span<const std::uint8_t>> take_part(std::span<const std::uint8_t>& bytes) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) return std::nullopt;
  std::memcpy(&length, bytes.data(), sizeof length);
  bytes = bytes.subspan(sizeof length);
  if (length > bytes.size()) return std::nullopt;
  const auto part = bytes.first(length);
  bytes = bytes.subspan(length);
  return part;
}

Bytes pack(const Product& product) {
  Bytes bytes;
  add_part(bytes,
           bytes_of(product.report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
  add_part(bytes, bytes_of(product.page));
  add_part(bytes, product.file);
  for (const MeshFile& companion : product.companions)
    add_part(bytes, bytes_of(companion.name)), add_part(bytes, companion.bytes);
  return bytes;
}

tl::expected<Product, Fault> unpack(std::span<const std::uint8_t> bytes) {
  const auto report = take_part(bytes), page = take_part(bytes), file = take_part(bytes);
  if (!report || !page || !file) return failed(std::string(kNoAnswer));
  Product product{nlohmann::json::parse(report->begin(), report->end(), nullptr, false),
                  {file->begin(), file->end()},
                  {page->begin(), page->end()}};
  if (!product.report.is_object()) return failed(std::string(kNoAnswer));
  while (!bytes.empty()) {
    const auto name = take_part(bytes), content = take_part(bytes);
    if (!name || !content) return failed(std::string(kNoAnswer));
    product.companions.push_back(
        {{name->begin(), name->end()}, {content->begin(), content->end()}});
  }
  return product;
}

Expected<Bytes> answer_to(const std::function<Expected<Product>(const ProgressReport&)>& task,
                          const SpillOptions& spill) {
  ProgressBar bar;
  return run_sandboxed(
      limits(spill),
      [&](const ProgressReport& progress) -> Expected<Bytes> {
        const auto product = task(progress);
        if (!product) return tl::unexpected(product.error());
        return pack(*product);
      },
      bar.report());
}

}  // namespace

tl::expected<Product, Fault> isolate(
    const std::string& subject, const std::function<Expected<Product>(const ProgressReport&)>& task,
    const SpillOptions& spill) {
  const auto answer = answer_to(task, spill);
  if (!answer) return failed(fmt::format("{}: {}", input_name(subject), answer.error().message));
  auto product = unpack(*answer);
  if (product && product->report.contains("note")) {
    std::istringstream notes(product->report["note"].get<std::string>());
    for (std::string note; std::getline(notes, note);)
      print_note(note);
  }
  return product;
}

}  // namespace vitrine::server::cli
